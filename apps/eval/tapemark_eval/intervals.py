"""How sure a share is that was counted: Wilson's interval, and what it means that markers share pictures."""

import math

Z_95 = 1.959964


def wilson(successes, trials, z=Z_95):
    """The interval of the true share, as (low, high); trials need not be whole."""
    if trials <= 0:
        return (0.0, 1.0)
    share = successes / trials
    centre = (share + z * z / (2 * trials)) / (1 + z * z / trials)
    half = z / (1 + z * z / trials) * math.sqrt(share * (1 - share) / trials + z * z / (4 * trials * trials))
    return (max(0.0, centre - half), min(1.0, centre + half))


def clustered(counts):
    """The interval of a share of which each picture gives several at once, as (successes, trials) a picture.

    Markers of one picture succeed and fail together, and tell less than as many of their own: the trials are divided
    by how much more the pictures differ than independent markers would (the design effect, at least 1)."""
    counts = [(hits, trials) for hits, trials in counts if trials > 0]
    trials = sum(each for _, each in counts)
    if trials == 0:
        return (0.0, 1.0)
    share = sum(hits for hits, _ in counts) / trials
    effect = trials / len(counts) if share in (0.0, 1.0) else 1.0
    if len(counts) > 1 and 0 < share < 1:
        pictures = len(counts)
        spread = sum((hits - share * each) ** 2 for hits, each in counts) * pictures / (pictures - 1)
        effect = max(1.0, spread / (trials * share * (1 - share)))
    return wilson(share * trials / effect, trials / effect)

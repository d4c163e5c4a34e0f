"""Which readings of a frame are right, against the renderer's truth."""

from .camera import CM_IDS, MARKER_IDS, TM_CODE


class Verdict:
    """Counts of a frame: markers wholly in view, those of them that were read, and wrong readings; the same for TMs.

    `something`: at least one right id or code was read, of a marker that is wholly in view or not."""

    def __init__(self):
        self.whole = self.right = self.wrong = 0
        self.tm_whole = self.tm_right = self.tm_wrong = 0
        self.id_read = self.something = False


def _tm_is_right(code, directed):
    return code == TM_CODE or (not directed and code == TM_CODE[::-1])


def _whole_ids(frame, marker):
    """Ids of the markers that are wholly in view, and whether the whole tape is."""
    if marker != "tape":
        return {MARKER_IDS[each["picture"]] for each in frame.truth["pictures"] if each["full"]}, False
    if frame.truth["segments"]:
        tape = any(each["full"] for each in frame.truth["segments"])
        return {each["id"] for each in frame.truth["cms"] if each["full"]}, tape
    printed = any(each["full"] for each in frame.truth["pictures"])  # a damaged tape is a picture
    return set(CM_IDS) if printed else set(), printed


def judge(frame, marker, ids, tms):
    """`ids` as read, None for a code that is no id; `tms` as (code, directed)."""
    verdict = Verdict()
    shown = set(CM_IDS if marker == "tape" else MARKER_IDS)
    whole, tape_whole = _whole_ids(frame, marker)
    read = set(ids) & shown
    verdict.whole = len(whole)
    verdict.right = len(whole & read)
    verdict.wrong = sum(each not in shown for each in ids)
    verdict.tm_whole = int(tape_whole)
    right_tms = sum(_tm_is_right(*each) for each in tms)
    verdict.tm_right = int(tape_whole and right_tms > 0)
    verdict.tm_wrong = len(tms) - right_tms
    verdict.id_read = bool(read)
    verdict.something = bool(read) or right_tms > 0
    return verdict

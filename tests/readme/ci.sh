#!/bin/sh
# Usage: ci.sh README
# The README shows the two commands and what the demo decodes, and CI runs the same test command, and
# what else it has to.
set -eu
readme=$1
ci=$(dirname "$readme")/.ci

fail()
{
    echo "$1"
    exit 1
}

for name in demo test; do
    grep -qx "sh .ci/$name" "$readme" || fail "$readme: no line 'sh .ci/$name'"
    sh -n "$ci/$name"
done
for call in .ci/test tests/vm/run; do
    grep -Eq "sh $call( [|][|] status=1)?\$" "$ci/run" || fail "$ci/run: does not call 'sh $call'"
done

job=$(grep '^build/release/bin/' "$ci/demo") || fail "$ci/demo: runs no program of build/release/bin"
grep -qxF "$job" "$readme" || fail "$readme: does not show what the demo runs: $job"

#!/bin/sh
# Usage: stack.sh FRAME_LIMIT_BYTES DEPTH_LIMIT_BYTES OBJECT...
# No frame of a function is over its limit or of a size known only at run time, no function calls itself,
# directly or through others, and no chain of calls goes deeper than its limit. Reads what gcc wrote beside the
# objects for -fcallgraph-info=su. Calls through pointers hide what is called, so there must be none.
set -eu
frame_limit=$1
depth_limit=$2
shift 2

graphs=
for object in "$@"; do
    graphs="$graphs ${object%.*}.ci"
done

# shellcheck disable=SC2086 # words of $graphs are files
awk -v frame_limit="$frame_limit" -v depth_limit="$depth_limit" '
    # Static functions are named "path/file.c:name".
    function short(name) { sub(/.*\//, "", name); return name }

    function fail(complaint) { print complaint; failed = 1 }

    # Bytes of stack from the entry of a function on, at the deepest.
    function depth_of(name,    i, called, depth) {
        if (name in depths) return depths[name]
        if (name in open) { fail("recursion through " short(name)); return 0 }
        open[name] = 1
        for (i = 1; i <= calls[name]; i++) {
            called = callee[name, i]
            if (called == "__indirect_call") fail("indirect call in " short(name))
            depth = depth_of(called)
            if (depth > deepest[name]) { deepest[name] = depth; next_below[name] = called }
        }
        delete open[name]
        return depths[name] = frame[name] + deepest[name]
    }

    # Fields between quotes: node: { title: "name" label: "name\nplace\nN bytes (static)\n..." }
    BEGIN { FS = "\""; by_size = "sort -rn | head -5" }
    /^node:/ && $4 ~ / bytes \(/ {
        split($4, line, /\\n/)
        split(line[3], size, " ")
        frame[$2] = size[1] + 0
        if (size[3] != "(static)") fail("dynamic frame of " short($2))
    }
    /^edge:/ { callee[$2, ++calls[$2]] = $4 }

    END {
        for (name in frame) {
            functions++
            if (frame[name] > frame_limit) fail("a frame of " frame[name] " bytes in " short(name))
            print frame[name], short(name) | by_size
            if (depth_of(name) > depth_of(top)) top = name
        }
        if (!functions) { print "no functions in the call graphs"; exit 1 }
        print functions " functions; largest frames in bytes:"
        fflush()
        close(by_size)
        if (depths[top] > depth_limit) fail(short(top) " goes " depths[top] " bytes deep, limit " depth_limit)
        print "deepest chain of calls " depths[top] " bytes:"
        for (name = top; name != ""; name = next_below[name]) print frame[name] + 0, short(name)
        exit failed
    }' $graphs

#!/bin/sh
# Usage: stack.sh FRAME_LIMIT_BYTES DEPTH_LIMIT_BYTES CALLS_THROUGH_POINTERS OBJECT...
# No frame of a function is over its limit or of a size known only at run time, no function calls itself,
# directly or through others, and no chain of calls goes deeper than its limit. Reads what gcc wrote beside the
# objects for -fcallgraph-info=su. Calls through pointers hide what is called: they are named to this check as
# "caller=callee ...", where a static function is file.c:name.
set -eu
frame_limit=$1
depth_limit=$2
pointers=$3
shift 3

graphs=
for object in "$@"; do
    graphs="$graphs ${object%.*}.ci"
done

# shellcheck disable=SC2086 # words of $graphs are files
awk -v frame_limit="$frame_limit" -v depth_limit="$depth_limit" -v pointers="$pointers" '
    function fail(complaint) { print complaint; failed = 1 }

    # gcc names a static function with the whole path of its file.
    function short(name) { sub(/.*\//, "", name); return name }

    function add_call(caller, called) { callee[caller, ++calls[caller]] = called }

    # Puts the calls that the caller of this script has named in the place of those through pointers.
    function resolve_pointers(    count, pairs, pair, i) {
        count = split(pointers, pairs, " ")
        for (i = 1; i <= count; i++) {
            split(pairs[i], pair, "=")
            if (!(pair[1] in indirect)) fail("no call through a pointer in " pair[1])
            if (!(pair[2] in frame)) fail("no function " pair[2])
            delete indirect[pair[1]]
            add_call(pair[1], pair[2])
        }
        for (i in indirect) fail("indirect call in " i)
    }

    # Bytes of stack from the entry of a function on, at the deepest.
    function depth_of(name,    i, depth) {
        if (name in depths) return depths[name]
        if (name in open) { fail("recursion through " name); return 0 }
        open[name] = 1
        for (i = 1; i <= calls[name]; i++) {
            depth = depth_of(callee[name, i])
            if (depth > deepest[name]) { deepest[name] = depth; next_below[name] = callee[name, i] }
        }
        delete open[name]
        return depths[name] = frame[name] + deepest[name]
    }

    # Fields between quotes: node: { title: "name" label: "name\nplace\nN bytes (static)\n..." }
    BEGIN { FS = "\""; by_size = "sort -rn | head -5" }
    /^node:/ && $4 ~ / bytes \(/ {
        split($4, line, /\\n/)
        split(line[3], size, " ")
        frame[short($2)] = size[1] + 0
        if (size[3] == "(dynamic)") fail("dynamic frame of " short($2))
    }
    /^edge:/ && $4 == "__indirect_call" { indirect[short($2)] = 1; next }
    /^edge:/ { add_call(short($2), short($4)) }

    END {
        resolve_pointers()
        for (name in frame) {
            functions++
            if (frame[name] > frame_limit) fail("a frame of " frame[name] " bytes in " name)
            print frame[name], name | by_size
            if (depth_of(name) > depth_of(top)) top = name
        }
        if (!functions) { print "no functions in the call graphs"; exit 1 }
        print functions " functions; largest frames in bytes:"
        fflush()
        close(by_size)
        if (depths[top] > depth_limit) fail(top " goes " depths[top] " bytes deep, limit " depth_limit)
        print "deepest chain of calls " depths[top] " bytes:"
        for (name = top; name != ""; name = next_below[name]) print frame[name] + 0, name
        exit failed
    }' $graphs

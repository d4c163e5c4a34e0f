# What the tests of the program share: a folder of their own, and runs whose output and exit status are looked at.

LC_ALL=C
export LC_ALL
work=$(mktemp -d)
trap 'chmod -R u+rwx "$work"; rm -rf "$work"' EXIT
cd "$work"

fail() {
    echo "FAILED: $*" >&2
    echo "--- standard output:" >&2
    head -c 2000 out >&2
    echo "--- standard error:" >&2
    head -c 2000 err >&2
    exit 1
}

# run STATUS ARGUMENT...: the program's output goes to the files out and err.
run() {
    wanted=$1
    shift
    got=0
    "$program" "$@" >out 2>err || got=$?
    [ "$got" -eq "$wanted" ] || fail "exit status $got instead of $wanted: $*"
}

lines() {
    wc -l <"$1" | tr -d ' '
}

expect_lines() {
    [ "$(lines "$1")" -eq "$2" ] || fail "$(lines "$1") lines in $1 instead of $2"
}

# expect FILE TEXT: a line with this text.
expect() {
    grep -qF -e "$2" "$1" || fail "no '$2' in $1"
}

expect_none() {
    ! grep -qF -e "$2" "$1" || fail "'$2' in $1"
}

# expect_refusal STATUS TEXT ARGUMENT...: nothing on standard output, and one line, with this text, on the other.
expect_refusal() {
    status=$1
    text=$2
    shift 2
    run "$status" "$@"
    expect_lines out 0
    expect_lines err 1
    expect err "$text"
}

# expect_list EXPECTED PATTERN REPLACEMENT: what sed makes of the lines of output, with blanks between them.
expect_list() {
    found=$(sed "s/$2/$3/" out | tr '\n' ' ')
    [ "$found" = "$1 " ] || fail "'$found' instead of '$1'"
}

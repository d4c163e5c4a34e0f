#!/bin/sh
# Usage: check_unit.sh UNIT PROGRAM SYSUSERS
# Whether systemd understands the unit, with the program where it was built, and how much it leaves open.
set -eu
unit=$1
program=$2
sysusers=$3

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sed "s|^ExecStart=[^ ]*|ExecStart=$program|" "$unit" >"$work/tapemark-stream.service"
grep -q "^ExecStart=$program --config /etc/tapemark/stream.conf$" "$work/tapemark-stream.service"

# Other units of the machine may have faults of their own: only what is said of this one counts.
systemd-analyze verify --man=no --generators=no "$work/tapemark-stream.service" 2>"$work/said" || true
if grep "tapemark" "$work/said"; then
    exit 1
fi
systemd-analyze security --offline=yes --threshold=30 "$work/tapemark-stream.service" >"$work/report" 2>&1 || {
    cat "$work/report"
    exit 1
}
tail -n 1 "$work/report"
systemd-sysusers --dry-run "$sysusers" >/dev/null 2>"$work/said" || {
    cat "$work/said"
    exit 1
}

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
# What the page of threats promises, each as a line of its own.
while read -r line; do
    grep -qxF -- "$line" "$unit" || {
        echo "the unit lacks: $line" >&2
        exit 1
    }
done <<LINES
User=tapemark
SupplementaryGroups=video dialout gpio
NoNewPrivileges=yes
CapabilityBoundingSet=
DevicePolicy=closed
ProtectSystem=strict
ProtectHome=yes
StateDirectory=tapemark
MemoryDenyWriteExecute=yes
SystemCallFilter=@system-service
SystemCallFilter=~@privileged @resources
UMask=0027
LINES
# Of devices it may have those of its groups, and no others.
if grep '^DeviceAllow=' "$unit" |
    grep -vE '=char-(video4linux|media|dma_heap|gpiochip|ttyAMA|ttyS|ttyUSB|ttyACM) rw$'; then
    exit 1
fi
for group in video dialout gpio; do
    grep -q "^m tapemark $group$" "$sysusers"
done

systemd-analyze security --offline=yes --threshold=17 "$work/tapemark-stream.service" >"$work/report" 2>&1 || {
    cat "$work/report"
    exit 1
}
tail -n 1 "$work/report"
systemd-sysusers --dry-run "$sysusers" >/dev/null 2>"$work/said" || {
    cat "$work/said"
    exit 1
}

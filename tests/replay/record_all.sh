#!/usr/bin/env bash
# record_all.sh [BIN [PATTERN]]: makes the recordings of recordings.list anew, with the programs of the folder BIN (build/check/bin),
# and verifies them: after a change of a map, of the game or of the format. PATTERN: only names that match it (grep -E).
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
bin=${1:-$root/build/check/bin}
pattern=${2:-.}
maps=$bin/../replay_maps
failed=0

bash "$here/maps.sh" "$bin/enfc" "$maps" || exit 1

# record NAME MAP TITLE OPTION...
record() {
    local name=$1 map=$maps/$2.enfmap title=$3
    shift 3
    [ -f "$map" ] || { echo "skipped: $name, for want of its map"; return 0; }
    "$bin/enfreplay" record --map "$map" --title "$title" "$@" -o "$here/$name.enfreplay" &&
        "$bin/enfreplay" verify --quiet --maps "$maps" "$here/$name.enfreplay"
}

while IFS='|' read -r name map options title; do
    name=${name// /} map=${map// /}
    [[ -z $name || $name == \#* ]] && continue
    grep -qE -- "$pattern" <<<"$name" || continue
    read -ra words <<<"${options//@/$here/scripts}"
    record "$name" "$map" "$(sed 's/^ *//; s/ *$//' <<<"$title")" "${words[@]}" || { echo "FAILED: $name"; failed=1; }
done <"$here/recordings.list"
exit "$failed"

#!/usr/bin/env bash
# record_all.sh [BIN [PATTERN]]: makes the recordings of recordings.list anew, with the programs of the folder BIN (build/check/bin),
# after a change of a map, of the simulation or of the format. PATTERN: only names that match it (grep -E).
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
bin=$(cd "${1:-$root/build/check/bin}" && pwd) || exit 1
pattern=${2:-.}
maps=$bin/../replay_maps
data=${ENF_SHARED_DATA:-$root/../shared/data}
failed=0
cd "$root" || exit 1

bash "$here/maps.sh" "$bin/enfc" "$maps" || exit 1

# The feet under the first eye of a path: "at=X,Y,Z".
first_of() {
    awk -F, 'NR == 2 { printf "at=%s,%.3f,%s\n", $2, $3 - 1.2, $4; exit }' "$1"
}

# record NAME MAP TITLE OPTION...
record() {
    local name=$1 map=$maps/$2.enfmap title=$3 options=() path="" word
    shift 3
    [ -f "$map" ] || { echo "skipped: $name, for want of its map"; return 0; }
    for word in "$@"; do
        word=${word/#@/$here/scripts} word=${word/#DATA/$data}
        [ "$word" = FIRST ] && word=$(first_of "$path")
        [ -f "$word" ] && path=$word
        options+=("$word")
    done
    "$bin/enfreplay" record --map "$map" --title "$title" "${options[@]}" -o "$here/$name.enfreplay"
}

while IFS='|' read -r name map options title; do
    name=${name// /} map=${map// /} title=${title# }
    [[ -z $name || $name == \#* ]] && continue
    grep -qE -- "$pattern" <<<"$name" || continue
    read -ra words <<<"$options"
    record "$name" "$map" "$title" "${words[@]}" || { echo "FAILED: $name"; failed=1; }
done <"$here/recordings.list"
exit "$failed"

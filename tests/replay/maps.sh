#!/usr/bin/env bash
# maps.sh ENFC FOLDER: compiles the maps that the recordings beside this script are of into FOLDER, those that are older than their
# level or the compiler. Levels of the shared data that are absent are left out with a message.
set -euo pipefail
[ $# -eq 2 ] || { echo "usage: maps.sh ENFC FOLDER" >&2; exit 2; }
enfc=$1 folder=$2
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
data=${ENF_SHARED_DATA:-$root/../shared/data}
mkdir -p "$folder"

# compile NAME LEVEL [OPTION...]
compile() {
    local name=$1 level=$2 map=$folder/$1.enfmap
    shift 2
    if [ ! -f "$level" ]; then
        echo "absent: $level; recordings of $name are skipped"
        return
    fi
    if [ ! "$map" -nt "$level" ] || [ ! "$map" -nt "$enfc" ]; then
        "$enfc" --quiet "$level" "$@" -o "$map" </dev/null
    fi
}

compile palace "$root/assets/palace/palace.glb" --project "$root/maps/palace/palace.json"
compile duplex "$data/buildings/duplex.glb"
for name in E1M1 E3M8 MAP01 MAP26; do
    compile "$name" "$data/freedoom/${name}_rooms.glb"
done

#!/usr/bin/env bash
# Plays the game as a person would, on a screen of its own: keys and mouse by xdotool, pictures looked at by their colours.
# play.sh BIN_DIR SOURCE_DIR WORK_DIR [sanitized]. Exit status 77: skipped.
set -uo pipefail

bin=$1 source=$2 work=$3 sanitized=${4:-no}
for tool in Xvfb xdotool; do
    command -v "$tool" >/dev/null || { echo "skipped: $tool is missing"; exit 77; }
done
[ -f "$source/assets/palace/palace.glb" ] || { echo "skipped: no palace"; exit 77; }

rm -rf "$work" && mkdir -p "$work/config" || exit 1
failures=0
check() { # WHAT COMMAND...
    local what=$1
    shift
    if "$@" >/dev/null 2>&1; then echo "ok      $what"; else echo "FAILED  $what"; failures=$((failures + 1)); fi
}

"$bin/enfc" --quiet "$source/assets/palace/palace.glb" --project "$source/maps/palace/palace.json" -o "$work/palace.enfmap" || exit 1

# A screen: Xvfb picks a free number and writes it to descriptor 3.
exec 3>"$work/display"
Xvfb -displayfd 3 -screen 0 1024x768x24 -nolisten tcp >"$work/xvfb.log" 2>&1 &
screen=$!
game=
trap '[ -n "$game" ] && kill "$game" 2>/dev/null; kill "$screen" 2>/dev/null' EXIT
for _ in $(seq 100); do [ -s "$work/display" ] && break; sleep 0.1; done
[ -s "$work/display" ] || { echo "skipped: Xvfb does not start"; exit 77; }
DISPLAY=:$(cat "$work/display")
export DISPLAY SDL_AUDIODRIVER=dummy SDL_VIDEODRIVER=x11 XDG_CONFIG_HOME="$work/config" LIBGL_ALWAYS_SOFTWARE=1
# What the driver and SDL keep until the process ends is theirs; what is ours is not excused. A driver that was unloaded before the count
# could not be told by name: a sanitized run keeps it.
preload=
if [ "$sanitized" != no ]; then
    printf 'leak:%s\n' libgallium _dri.so libGLX libGL libEGL libglapi libLLVM libX11 libxcb libdbus libSDL2 >"$work/suppressions"
    export LSAN_OPTIONS="suppressions=$work/suppressions:print_suppressions=0" ASAN_OPTIONS=detect_leaks=1:verify_asan_link_order=0
    echo 'int dlclose(void *handle); int dlclose(void *handle) { (void)handle; return 0; }' >"$work/keep.c"
    "${CC:-cc}" -shared -fPIC -o "$work/keep.so" "$work/keep.c" && preload=$work/keep.so
fi

said() { # PATTERN: has the game said it, within some seconds?
    for _ in $(seq 600); do
        grep -q "$1" "$work/said" && return 0
        kill -0 "$game" 2>/dev/null || return 1
        sleep 0.1
    done
    return 1
}
expect() { check "$1" said "$2"; : >"$work/said"; }
key() { xdotool key "$@"; sleep 0.4; }
hold() { xdotool keydown "$1"; sleep "$2"; xdotool keyup "$1"; }
shots=0
shot() { # the window as F12 writes it; it must hold something
    local before=$shots file
    file=$(printf '%s/enfilade_%03d.png' "$work" "$shots")
    key F12
    for _ in $(seq 100); do [ -s "$file" ] && break; sleep 0.1; done
    shots=$((before + 1))
    check "picture of $1" test "$(stat -c %s "$file" 2>/dev/null || echo 0)" -gt "$2"
}
differ() { ! cmp -s "$(printf '%s/enfilade_%03d.png' "$work" "$1")" "$(printf '%s/enfilade_%03d.png' "$work" "$2")"; }

cd "$work" || exit 1
: >said
mkdir -p "$work/config/enfilade"
echo '{"width": 640, "height": 400, "vsync": false}' >"$work/config/enfilade/settings.json"
env LD_PRELOAD="$preload" "$bin/enfilade" --map "$work/palace.enfmap" --river "$source/maps/palace/river.csv" --record "$work/night.enfreplay" --tell \
    >>said 2>errors &
game=$!
expect "it opens, loads, and plays what is recorded" "mode playing menu none"
shot "the entrance hall" 20000
hold w 1.5
for _ in 1 2 3 4 5 6; do xdotool mousemove_relative -- 40 4; sleep 0.1; done
key e
shot "another view" 20000
check "walking and looking change the picture" differ 0 1
key F1; key F2; key F4; key F5; key F6; key F8; sleep 2
shot "the engineer's overlay" 20000
check "the overlay shows" differ 1 2
key F3; key F7; hold s 0.5; key F7; key F7; key F7; key F3
key F1; key F2; key F4; key F5; key F6; key F8
key Tab
shot "the map" 10000
key Tab
hold w 6 # undisturbed: warm frames
key Escape
expect "Esc pauses" "menu pause"
shot "the menu" 10000
key Down; key Down; key Return
expect "settings open" "menu settings"
key Return
expect "controls open" "menu controls"
key Right; key Right; key Down; key Return; key Escape
expect "back to settings" "menu settings"
key Escape
expect "back to the pause" "menu pause"
settings=$work/config/enfilade/settings.json
check "settings are saved" test -s "$settings"
check "sensitivity as set" grep -q '"sensitivity": *1.2' "$settings"
check "inverted as set" grep -q '"invert": *true' "$settings"
check "settings are JSON" python3 -m json.tool "$settings"
window=$(xdotool search --name '^Enfilade$' | tail -1)
xdotool windowsize "$window" 700 500; sleep 1
shot "the window, resized" 5000
xdotool windowsize "$window" 640 400; sleep 1
xdotool mousemove --window "$window" 60 172; sleep 0.5; xdotool click 1
expect "a click on Resume resumes" "mode playing menu none"
hold a 0.7
key Escape
expect "Esc pauses again" "menu pause"
key Escape
expect "Esc resumes" "mode playing menu none"
key space
key Escape
expect "pause again" "menu pause"
key Up; key Up; key Return
expect "back to the title" "mode title menu title"
shot "the title" 10000
key Down; key Return
expect "the guided tour" "mode tour menu none"
key w; sleep 1
key Escape
expect "and back" "mode title menu title"
key Return
expect "a new game" "mode playing menu none"
hold w 1
key Escape
expect "which pauses" "menu pause"
key Down; key Return
expect "and starts again" "mode playing menu none"
key Escape
expect "pause, the last time" "menu pause"
key Up; key Return # the last row: quit
for _ in $(seq 600); do kill -0 "$game" 2>/dev/null || break; sleep 0.1; done
wait "$game"
status=$?
game=
cat errors
check "exit status 0 (was $status)" test "$status" -eq 0
read -r _ frames _ ticks _ warm _ heap _ sounds _ mixed <<<"$(grep '^frames' said)"
echo "frames ${frames:-?}, ticks ${ticks:-?}, warm frames ${warm:-?} with ${heap:-?} heap calls, sounds ${sounds:-?}, mixed ${mixed:-?}"
check "frames were drawn" test "${frames:-0}" -gt 20
check "ticks went by" test "${ticks:-0}" -gt 100
check "there were warm frames" test "${warm:-0}" -gt 0
check "warm frames call no heap" test "${heap:-1}" -eq 0
check "sounds were mixed" test "${mixed:-0}" -gt 10000
check "the recording verifies without a window" "$bin/enfreplay" verify --map "$work/palace.enfmap" "$work/night.enfreplay"
check "and in the game" env LD_PRELOAD="$preload" "$bin/enfilade" --map "$work/palace.enfmap" --headless --play "$work/night.enfreplay"

# The same in a window, fast, to its end.
check "and in a window" timeout 120 env LD_PRELOAD="$preload" "$bin/enfilade" --map "$work/palace.enfmap" --play "$work/night.enfreplay" \
    --speed 30 --mute --size 320x240 --frames 4000

# Hostile settings: defaults, a message, and no end.
for text in '{"fov": 1e999, "keys": 3, "volume": "loud"}' '[[[[' '' '{"keys": {"forward": "no such key", "jump": 7}}'; do
    printf '%s' "$text" >hostile.json
    check "settings: $text" env LD_PRELOAD="$preload" "$bin/enfilade" --map "$work/palace.enfmap" --mute --config hostile.json --size 320x240 --frames 12
done
[ "$sanitized" = no ] || check "no leak, no error" test ! -s errors
echo "$failures failed"
[ "$failures" -eq 0 ]

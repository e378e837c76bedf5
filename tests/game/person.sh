# Common to the tests that drive the game as a person would: a screen of its own, keys and mouse by xdotool, pictures that the game writes.
# Sourced, with the arguments BIN_DIR SOURCE_DIR WORK_DIR [sanitized]. Exit status 77: skipped. The working folder is WORK_DIR.
# shellcheck shell=bash
set -uo pipefail

bin=$1 source=$2 work=$3 sanitized=${4:-no}
for tool in Xvfb xdotool; do
    command -v "$tool" >/dev/null || { echo "skipped: $tool is missing"; exit 77; }
done
[ -f "$source/assets/palace/palace.glb" ] || { echo "skipped: no palace"; exit 77; }

rm -rf "$work" && mkdir -p "$work/config" || exit 1
cd "$work" || exit 1
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

begin() { # ARGUMENT...: the game, in the background; what it says is in `said`, its errors in `errors`
    : >said
    : >errors
    # A shell's background jobs ignore SIGINT, and would hand that down.
    env --default-signal=INT LD_PRELOAD="$preload" "$bin/enfilade" --map "$work/palace.enfmap" "$@" >>said 2>errors &
    game=$!
}
ended() { # has the game ended by itself, within some seconds? `status` is its exit status then
    for _ in $(seq 600); do kill -0 "$game" 2>/dev/null || break; sleep 0.1; done
    kill -9 "$game" 2>/dev/null && echo "killed: it did not end"
    wait "$game"
    status=$?
    game=
}
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

finish() {
    echo "$failures failed"
    [ "$failures" -eq 0 ]
    exit
}

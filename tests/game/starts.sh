#!/usr/bin/env bash
# How the game begins and ends: what is wrong with a command line, a map or a recording is one line on stderr and an exit status, at once,
# with a display and without; SIGTERM and SIGINT end it in order, with the recording saved; what a command line says is never saved.
# starts.sh BIN_DIR SOURCE_DIR WORK_DIR [sanitized]. Exit status 77: skipped.
. "$(dirname "${BASH_SOURCE[0]}")/person.sh"

limit=10
[ "$sanitized" = no ] || limit=100
# refused STATUS PATTERN ARGUMENT...: it ends soon, with that status, one error, and nothing on stdout.
refused() {
    local wanted=$1 pattern=$2
    shift 2
    timeout -s KILL "$limit" env LD_PRELOAD="$preload" "$bin/enfilade" "$@" >refused.out 2>refused.err
    local status=$?
    check "exit status $wanted (was $status): $*" test "$status" -eq "$wanted"
    check "it says why: $pattern" grep -q -- "$pattern" refused.err
    check "in one line" test "$(grep -vc -- '--help lists' refused.err)" -eq 1
    check "and nothing else" test ! -s refused.out
}

map=$work/palace.enfmap
head -c 100000 "$map" >cut.enfmap
printf 'enfreplay 1\nnonsense\n' >bad.enfreplay
echo text >text
ln "$map" other.enfmap
unset SDL_VIDEODRIVER
for display in "$DISPLAY" ""; do
    export DISPLAY=$display
    [ -n "$display" ] || unset DISPLAY
    echo "with DISPLAY ${display:-not set}"
    refused 1 'missing.enfreplay: cannot open' --map "$map" --play missing.enfreplay
    refused 1 'missing.enfmap: cannot open' --map missing.enfmap
    refused 1 'cut.enfmap' --map cut.enfmap
    refused 1 'text: .*header' --map text
    refused 1 'text: not a recording' --map "$map" --play text
    refused 1 'bad.enfreplay' --map "$map" --play bad.enfreplay
    refused 1 'map01_walk.enfreplay: recorded with the map' --map "$map" --play "$source/tests/replay/map01_walk.enfreplay"
    refused 1 'no/such/folder.enfreplay' --map "$map" --record no/such/folder.enfreplay
    refused 1 'river.csv: cannot open' --map "$map" --river no/river.csv
    refused 1 'no guided tour' --map other.enfmap --tour
    refused 1 'missing.enfreplay: cannot open' --map "$map" --headless --play missing.enfreplay
    refused 2 'unknown option' --map "$map" --no-such-option
    refused 2 'exclude each other' --map "$map" --play a --record b
    refused 2 'needs --frames' --map "$map" --shot out.png
    refused 2 'needs --play FILE, --tour or --shot' --map "$map" --headless
    refused 2 'needs a window' --map "$map" --headless --shot a.png --record a.enfreplay
done
refused 1 'no display: neither DISPLAY nor WAYLAND_DISPLAY.*--headless' --map "$map"
DISPLAY=:$(cat display)
export DISPLAY
DISPLAY=:9999 refused 1 'no display: nothing answers at DISPLAY=:9999.*--headless' --map "$map"

# Pictures without a window, and without a display.
unset DISPLAY
check "a picture of a new game" "$bin/enfilade" --map "$map" --headless --shot new.png --size 320x180
check "is one" test "$(stat -c %s new.png)" -gt 10000
check "a picture of the tour" "$bin/enfilade" --map "$map" --river "$source/maps/palace/river.csv" --headless --tour --frames 2 --shot tour.png --size 320x180
check "is another" test "$(stat -c %s tour.png)" -gt 10000 -a "$(cmp -s new.png tour.png; echo $?)" -eq 1
refused 1 'no/such/folder.png' --map "$map" --headless --shot no/such/folder.png
DISPLAY=:$(cat display)
export DISPLAY

settings=config/enfilade/settings.json
mkdir -p config/enfilade
echo '{"width": 640, "height": 400, "vsync": false, "sensitivity": 1.5}' >"$settings"
cp "$settings" before.json

# --frames counts what is drawn of the game, not what a slow machine shows while it loads.
begin --frames 3 --mute --tell
ended
check "three frames were asked for" test "$status" -eq 0
check "and drawn" grep -q '^frames 3 ' said

# Signals, wherever the game stands.
for signal in TERM INT; do
    begin --record "$signal.enfreplay" --tell
    expect "a game to be ended by SIG$signal" "mode playing menu none"
    hold w 1
    [ "$signal" = TERM ] || { key Escape; expect "in a menu" "menu pause"; }
    kill -s "$signal" "$game"
    ended
    check "SIG$signal ends it in order (exit status $status)" test "$status" -eq 0
    check "the recording is saved" "$bin/enfreplay" verify --map "$map" "$signal.enfreplay"
    check "and nothing is left beside it" test ! -e "$signal.enfreplay.part"
    check "no error" test ! -s errors
done
begin --tell
sleep 0.7
kill -s TERM "$game" # while it loads, or before
ended
check "SIGTERM at the start ends it (exit status $status)" test "$status" -eq 0 -o "$status" -eq 143

# What a command line says holds once.
check "settings that nobody changed stay as they are" cmp "$settings" before.json
begin --size 500x350 --fullscreen --tell
expect "another size for once" "mode title menu title"
key Down Down Return # settings
expect "settings open" "menu settings"
key Return
expect "controls open" "menu controls"
key Right Escape
expect "and close" "menu settings"
key Escape
expect "and are saved" "menu title"
key Up Up Up Return # quit: the last row
ended
check "exit status 0 (was $status)" test "$status" -eq 0
check "what was changed is saved" grep -q '"sensitivity": *1.6' "$settings"
check "the width of the command line is not" grep -q '"width": *640' "$settings"
check "nor its height" grep -q '"height": *400' "$settings"
check "nor the full screen" grep -q '"fullscreen": *false' "$settings"
finish

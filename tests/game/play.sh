#!/usr/bin/env bash
# Plays the game as a person would, on a screen of its own: keys and mouse by xdotool, pictures looked at by their colours.
# play.sh BIN_DIR SOURCE_DIR WORK_DIR [sanitized]. Exit status 77: skipped.
. "$(dirname "${BASH_SOURCE[0]}")/person.sh"

mkdir -p config/enfilade
echo '{"width": 640, "height": 400, "vsync": false}' >config/enfilade/settings.json
begin --river "$source/maps/palace/river.csv" --record "$work/night.enfreplay" --tell
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
xdotool windowfocus "$(xdotool search --maxdepth 0 --name '.*' | head -1)" # the screen's own window
expect "losing the focus pauses" "menu pause"
xdotool windowfocus "$window"
key Escape
expect "and Esc resumes" "mode playing menu none"
key F11; sleep 1; key F11; sleep 1
shot "the window, after it was the whole screen" 20000
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
ended
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
check "and as a picture" env LD_PRELOAD="$preload" "$bin/enfilade" --map "$work/palace.enfmap" --headless --play "$work/night.enfreplay" \
    --shot night.png --frames 100 --size 320x180
check "that is written" test "$(stat -c %s night.png)" -gt 10000

# The same in a window, fast, to its end.
check "and in a window" timeout 120 env LD_PRELOAD="$preload" "$bin/enfilade" --map "$work/palace.enfmap" --play "$work/night.enfreplay" \
    --speed 30 --mute --size 320x240 --frames 4000

# Hostile settings: defaults, a message, and no end.
for text in '{"fov": 1e999, "keys": 3, "volume": "loud"}' '[[[[' '' '{"keys": {"forward": "no such key", "jump": 7}}'; do
    printf '%s' "$text" >hostile.json
    check "settings: $text" env LD_PRELOAD="$preload" "$bin/enfilade" --map "$work/palace.enfmap" --mute --config hostile.json --size 320x240 --frames 12
done
[ "$sanitized" = no ] || check "no leak, no error" test ! -s errors
finish

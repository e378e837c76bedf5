#!/bin/sh
# The published experiments on moving objects as one report: runs them, keeps the rows as CSV, draws each as a picture.
# usage: movers_report.sh ENFBENCH FOLDER [--set KEY=VALUE ...]
set -eu
bench=${1:?the enfbench program} folder=${2:?a folder for the report}
shift 2
mkdir -p "$folder"
plot=$(command -v gnuplot || true)

# picture EXPERIMENT SCENE KEY LABEL: median time over the number after KEY= in the parameters, a line a technique.
picture() {
    csv="$folder/$1.csv" data="$folder/$1-$3.dat"
    awk -F, -v scene="$2" -v key="$3=" '
        NR > 1 && $2 ~ scene {
            n = split($0, words, /[ ",]+/); x = ""
            for (i = 1; i <= n; i++) if (index(words[i], key) == 1) x = substr(words[i], length(key) + 1)
            split($0, quoted, "\""); split(quoted[3], t, ","); split(quoted[5], numbers, ",")
            if (x != "") print t[2], x, numbers[3]
        }' "$csv" | sort -k1,1 -k2,2g | awk '{ if (last != "" && last != $1) print "\n"; if (last != $1) print "\"" $1 "\""; last = $1; print $2, $3 }' >"$data"
    [ -n "$plot" ] && [ -s "$data" ] || return 0
    lines=$(grep -c '^"' "$data")
    for type in svg png; do
        "$plot" <<PLOT
set terminal $type size 900,600
set output "$folder/$1-$3.$type"
set logscale xy
set xlabel "$4"
set ylabel "median time of a frame, microseconds"
set key outside right
set title "$1: $2"
plot for [i=0:$lines-1] "$data" index i using 1:2 with linespoints title columnheader(1)
PLOT
    done
}

for experiment in S1 S2 S3 S4 S5 S6 B1 B2 B3 B4; do
    case $experiment in S1 | S2) "$bench" run $experiment --csv "$folder/$experiment.csv" >"$folder/$experiment.txt" ;;
    *) "$bench" run $experiment --csv "$folder/$experiment.csv" "$@" >"$folder/$experiment.txt" ;; esac
    echo "$experiment: $folder/$experiment.csv"
done
picture S1 update ratio "side of the large cube / side of the small one"
picture S3 "static varies" rooms "rooms"
picture S4 "four a room" rooms "rooms, four movers each"
picture S5 "125 rooms" movers "movers"
picture S6 period period "ticks"
for scene in B1 B2 B3 B4; do
    picture $scene "test 1" polygons "polygons of a mover"
    picture $scene "test 3" speed "metres a second"
    [ $scene = B1 ] || picture $scene "test 2" movers "movers"
done

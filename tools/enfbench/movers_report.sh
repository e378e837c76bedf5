#!/bin/sh
# The published experiments on moving objects as one report: runs them, keeps the rows as CSV, draws each as SVG and PNG, and puts
# curves, numbers and published claims side by side in FOLDER/report.html.
# usage: movers_report.sh ENFBENCH FOLDER [EXPERIMENT ...]
# With names, only these are measured anew; the rest of the report is made from what the folder holds. ENFBENCH - measures nothing.
set -eu
bench=${1:?the enfbench program} folder=${2:?a folder for the report}
shift 2
command -v gnuplot >/dev/null || { echo "movers_report.sh: gnuplot (Debian: gnuplot-nox) draws the curves, and is missing" >&2; exit 1; }
mkdir -p "$folder"
[ $# -gt 0 ] || set -- movers million losing S1 S2 S3 S4 S5 S6 B1 B2 B3 B4
for experiment; do
    [ "$bench" != - ] || break
    "$bench" run "$experiment" --csv "$folder/$experiment.csv" --json "$folder/$experiment.json" >"$folder/$experiment.txt"
    echo "$experiment: $folder/$experiment.csv"
done
python3 -B "$(dirname "$0")/movers_report.py" "$folder"

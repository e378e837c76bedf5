#!/usr/bin/env python3
"""Curves and one HTML page from the rows that enfbench wrote: what was published on moving objects, and what we measured.
usage: movers_report.py FOLDER    reads FOLDER/*.csv; writes FOLDER/*.svg, *.png (with gnuplot) and FOLDER/report.html"""

import csv
import html
import pathlib
import shutil
import subprocess
import sys

ORDER = ["zbuffer", "hierarchical-z", "tbv", "update-all", "frustum", "flat", "sweep", "plain", "constant", "adaptive", "maximal", "optimal", "reach",
         "naive", "lca"]
# A technique looks the same in every figure: colour, point, dash (volumes are drawn whole), width.
LOOKS = {"zbuffer": ("#000000", 2, 2, 1.5), "hierarchical-z": ("#d62728", 5, 2, 2), "tbv": ("#ff7f0e", 4, 1, 2),
         "update-all": ("#8c564b", 9, 2, 2), "frustum": ("#7f7f7f", 1, 2, 1.5), "flat": ("#9a9b00", 3, 2, 1.5),
         "sweep": ("#17becf", 6, 2, 1.5), "plain": ("#aaaaaa", 12, 2, 1.5), "constant": ("#9467bd", 8, 1, 1.5),
         "adaptive": ("#e377c2", 10, 1, 1.5), "maximal": ("#2ca02c", 11, 1, 1.5), "optimal": ("#66c2a5", 13, 1, 1.5),
         "reach": ("#1f4fd0", 7, 1, 2.5), "naive": ("#d62728", 5, 2, 2), "lca": ("#1f4fd0", 7, 1, 2),
         "B1": ("#1f4fd0", 7, 1, 2), "B2": ("#d62728", 5, 1, 2), "B3": ("#2ca02c", 9, 1, 2), "B4": ("#ff7f0e", 11, 1, 2)}
VOLUMES = ("constant", "adaptive", "maximal", "optimal", "reach")


def read(folder, name):
    """Rows of an experiment; parameters become columns."""
    path = folder / (name + ".csv")
    if not path.exists():
        return []
    with path.open() as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        row.update(word.split("=", 1) for word in row["params"].split())
    return rows


def number(text):
    return float(text) if text not in ("", None) else None


def short(value):
    if value is None:
        return "–"
    if value >= 100:
        return f"{value:,.0f}"
    return f"{value:.3g}"


# ---- curves ---------------------------------------------------------------------------------------------------------

def curves(rows, x, y):
    """A dictionary technique -> points, in the order of ORDER."""
    out = {}
    for technique in ORDER:
        points = [(number(row[x]), number(row[y])) for row in rows if row["technique"] == technique]
        points = sorted((a, b) for a, b in points if a is not None and b is not None and b > 0)
        if points:
            out[technique] = points
    return out


def around(values):
    """A range for a logarithmic axis with a little room on both sides."""
    return f"[{min(values) / 1.25:.9g}:{max(values) * 1.25:.9g}]"


def tics(values):
    """Marks of a logarithmic axis: powers of ten, and where these are few 2 and 5 times them."""
    low, high = min(values) / 1.25, max(values) * 1.25
    steps = (1, 1.5, 2, 3, 5, 7) if high / low < 12 else (1, 2, 5) if high / low < 300 else (1,)
    marks = [float(f"{step}e{power}") for power in range(-9, 12) for step in steps]
    return "(" + ", ".join(f'"{mark:,.9g}" {mark:.9g}' for mark in marks if low <= mark <= high) + ")"


def draw(folder, name, title, lines, xlabel, ylabel, even=False):
    """An SVG for the page and a PNG beside it; the SVG's text, or nothing without gnuplot or points. `even`: marks 1."""
    if not lines or shutil.which("gnuplot") is None:
        return ""
    data = folder / (name + ".dat")
    with data.open("w") as file:
        for technique, points in lines.items():
            file.write(f'"{technique}"\n')
            file.writelines(f"{a:.9g} {b:.9g}\n" for a, b in points)
            file.write("\n\n")
    xs = [a for points in lines.values() for a, _ in points]
    ys = [b for points in lines.values() for _, b in points] + ([1.0] if even else [])
    plots = []
    for i, technique in enumerate(lines):
        colour, point, dash, width = LOOKS[technique]
        plots.append(f'"{data}" index {i} using 1:2 with linespoints lc rgb "{colour}" pt {point} ps 0.8 dt {dash} lw {width} '
                     f'title "{technique}"')
    plots += ['1 with lines lc rgb "#888888" dt 3 lw 2 title "even"'] if even else []
    for terminal, size in (("svg", "760,440"), ("png", "1140,660")):
        script = f"""set terminal {terminal} size {size} noenhanced background rgb "white"
set output "{folder / name}.{terminal}"
set logscale xy
set xtics {tics(xs)}
set ytics {tics(ys)}
set xrange {around(xs)}
set yrange {around(ys)}
set xlabel "{xlabel}"
set ylabel "{ylabel}"
set key outside right samplen 3
set grid lc rgb "#cccccc"
set title "{title}"
plot {", ".join(plots)}
"""
        subprocess.run(["gnuplot"], input=script, text=True, check=True)
    svg = (folder / (name + ".svg")).read_text()
    return "<figure>" + svg[svg.index("<svg"):] + "</figure>"


def table(head, lines):
    cells = "".join(f"<th>{html.escape(h)}</th>" for h in head)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(str(c))}</td>" for c in line) + "</tr>" for line in lines)
    return f"<table><tr>{cells}</tr>{body}</table>"


def values_table(lines, xlabel):
    """Techniques across, values of x down."""
    xs = sorted({a for points in lines.values() for a, _ in points})
    rows = [[short(x)] + [short(dict(points).get(x)) for points in lines.values()] for x in xs]
    return table([xlabel] + list(lines), rows)


def section(folder, rows, name, title, x, xlabel, y="mean_us", ylabel="microseconds a frame, mean"):
    lines = curves(rows, x, y)
    if not lines:
        return "<p class=missing>Not measured in this folder.</p>"
    return draw(folder, name, title, lines, xlabel, ylabel) + values_table(lines, xlabel)


def ratio(lines, base, technique):
    """base / technique at each x that both have."""
    other = dict(lines.get(technique, []))
    return [(a, b / other[a]) for a, b in lines.get(base, []) if other.get(a)]


def proof(rows):
    """What every row must say: nothing lost, nothing late."""
    lost = sum(number(row["lost_objects"]) or 0 for row in rows)
    late = sum(number(row["late"]) or 0 for row in rows)
    return f"<p>{len(rows)} rows; objects lost: {lost:.0f}; volumes met after their expiry: {late:.0f}.</p>"


# ---- what is said of a claim ----------------------------------------------------------------------------------------

EVEN = 0.97  # what is not slower than this is even, not behind: the clock is no better


def claim(text, outcome, found):
    """A claim of the source, what became of it here, and by what factor."""
    return f"<p class=claim><b>Claim:</b> {text} <b>{outcome}:</b> {found}</p>"


def times(value):
    return short(value) + "×"


def growth(lines, technique):
    """Of a curve: its last value over its first; None without one."""
    points = lines.get(technique, [])
    return points[-1][1] / points[0][1] if len(points) > 1 else None


def span(points):
    """The least and the largest of ratios, with where they are."""
    low, high = min(points, key=lambda p: p[1]), max(points, key=lambda p: p[1])
    return f"{times(low[1])} (at {short(low[0])}) to {times(high[1])} (at {short(high[0])})"


def outcome(*conditions):
    return "Reproduced" if all(conditions) else "Reproduced in part" if any(conditions) else "Not reproduced"


# ---- the parts of the page ------------------------------------------------------------------------------------------

def sizes(folder):
    """PEERS' sizes: the numbers of other engines stand in the text, as they were measured elsewhere."""
    rows = read(folder, "movers")
    published = {("100", "1000"): ("3.3", "37", "124", "376"), ("1024", "10000"): ("32", "238", "1,910", "5,150"),
                 ("10000", "10000"): ("42", "305", "3,080", "11,000")}
    out = ["<h2>At the sizes of other engines</h2><p>Objects that walk from room to room, an eye that walks; motion, index and ",
           "visibility of a frame, microseconds, median. <i>plain</i> is a plain-C reference of our own (arrays, a list a room, ",
           "rectangles on the screen, no care); <i>flat</i> the same with our traversal. The last four columns were measured by ",
           "others on another machine, with update and cull; these programs cannot be run here: compare ratios, not times.</p>"]
    keys = sorted({(row["rooms"], row["movers"]) for row in rows}, key=lambda k: (int(k[1]), int(k[0])))
    techniques = [t for t in ORDER if any(row["technique"] == t for row in rows)]
    lines = []
    for key in keys:
        found = {row["technique"]: number(row["median_us"]) for row in rows if (row["rooms"], row["movers"]) == key}
        lines.append([" / ".join(key)] + [short(found.get(t)) for t in techniques] + list(published.get(key, ("–",) * 4)))
    out.append(table(["rooms / movers"] + techniques + ["plain C", "MOC 320×180", "dhewm3", "OGRE zones"], lines))
    out.append(proof(rows))
    return "".join(out)


def medians(row, column):
    return short(number(row[column]) / number(row["median_us"])) if row.get(column) else "–"


def million(folder):
    rows = read(folder, "million")
    out = ["<h2>A million movers in 10,000 rooms</h2><p>Walking eye. <i>ns</i>: the mean frame divided by the objects that are not ",
           "drawn. <i>worst</i>: the worst frame in medians, and how many volumes came into sight in it; <i>calm</i>: the worst of the ",
           "frames that expose no more than the median one. <i>free</i>: only a largest speed is known. Wanted: 0.3 ns, no frame ",
           "above 4 medians (free); 50 times faster than update-all, 10 times than flat and sweep (spline); 5 times (linear); 160 ",
           "bytes.</p>"]
    lines = []
    for name in ("free", "linear", "spline", "character", "hidden"):
        for movers in ("10000", "1000000"):
            part = [row for row in rows if row["scene"] == name and row["movers"] == movers]
            best = min((number(r["mean_us"]) for r in part if r["technique"] in VOLUMES), default=None)
            for r in part:
                mean = number(r["mean_us"])
                lines.append([name, movers, r["technique"], short(number(r["median_us"])), short(mean),
                              short(number(r["p99_us"])), short(number(r["max_us"])),
                              short(number(r["max_us"]) / number(r["median_us"])), r.get("worst_appeared") or "–",
                              medians(r, "calm_max_us"), short(number(r["ns_object"])),
                              short(mean / best) if best else "–", short(number(r["bytes_object"])), r["lost_objects"]])
    out.append(table(["motion", "movers", "technique", "median µs", "mean", "p99", "max", "worst", "appeared", "calm", "ns", "× the best volume",
                      "bytes an object", "lost"], lines))
    means = {row["movers"]: number(row["mean_us"]) for row in rows if row["scene"] == "hidden" and row["technique"] == "reach"}
    if len(means) == 2:
        out.append(f"<p>Known paths, the visible ones equal: a frame with 10⁶ hidden movers costs "
                   f"{means['1000000'] / means['10000']:.2f} times one with 10⁴ (wanted: at most 1.5).</p>")
    return "".join(out) + proof(rows)


def updates(folder):
    out = ["<h2>Sudarsky &amp; Gotsman 1996</h2><h3>S1 and S2: update from the least common ancestor</h3>",
           "<p>Claims: the speed-up over the naive update grows with the logarithm of the ratio of sizes (S1); 2.7 on a table for ",
           "four, 5,745 polygons, tree depth 11 (S2). Time of the update alone.</p>"]
    s1 = read(folder, "S1")
    out.append(section(folder, s1, "S1", "S1: time of an update", "ratio", "side of the large cube / of the small", "median_us",
                       "microseconds an update"))
    lines = [[row["params"], row["technique"], short(number(row["median_us"])), short(number(row["ratio_median"])),
              short(number(row["nodes"]))] for row in s1 + read(folder, "S2")]
    out.append(table(["scene", "update", "µs", "naive / this", "nodes passed"], lines))
    points = ratio(curves(s1, "ratio", "median_us"), "naive", "lca")
    if len(points) > 1:
        out.append(claim("the speed-up of scene 1 grows with the logarithm of the ratio of sizes.",
                         outcome(points[-1][1] > points[0][1]),
                         f"{times(points[0][1])} at a ratio of {short(points[0][0])}, {times(points[-1][1])} at "
                         f"{short(points[-1][0])}; in nodes passed "
                         + ", ".join(times(number(row["ratio_best"])) for row in s1 if row["technique"] == "lca") + "."))
    for row in read(folder, "S2"):
        if row["technique"] == "lca":
            won = number(row["ratio_median"])
            where = "the table alone in a room" if row["rooms"] == "1" else f"the same table in one of {row['rooms']} rooms"
            out.append(claim("2.7× on the table for four (scene 2).", outcome(won >= 2.7), f"{times(won)} ({where})."))
    return "".join(out)


def figure_6(name, lines, many):
    """What S3, S4 and S5 claim of Z-buffer, hierarchical Z-buffer and temporal bounding volumes, and ours beside them."""
    lead = ratio(lines, "hierarchical-z", "tbv")
    against_z = ratio(lines, "zbuffer", "hierarchical-z")
    ours = ratio(lines, "tbv", "reach")
    if not lead or not against_z or not ours:
        return ""
    z, hz, tbv = (growth(lines, t) or 1.0 for t in ("zbuffer", "hierarchical-z", "tbv"))
    ends = "from the fewest to the most movers" if name == "S5" else "from the smallest to the largest model"
    grown = (f"{ends} the Z-buffer grows {times(z)}, the hierarchical Z-buffer {times(hz)}, "
             f"volumes in its octree (tbv) {times(tbv)}, ours (reach) {times(growth(lines, 'reach'))}")
    ahead = f"tbv is {span(lead)} as fast as the hierarchical Z-buffer; ours is {span(ours)} as fast as tbv"
    behind = [short(a) for a, b in against_z if b < EVEN]
    worse = "at every size" if len(behind) == len(against_z) else "at " + ", ".join(behind) if behind else "nowhere"
    if many:
        text = "(of the same with few movers) temporal volumes a little ahead. With so many, what moves outweighs what stands still."
        kept = outcome(all(b >= EVEN for _, b in lead))
    elif name == "S3":
        text = "the Z-buffer is linear in the size of the model, the others flat, temporal volumes a little ahead."
        kept = outcome(z > 4.0 * hz, hz < 4.0 and tbv < 4.0, all(b >= EVEN for _, b in lead))
    elif name == "S4":
        text = "the hierarchical Z-buffer is worse than the plain one, temporal volumes are far ahead."
        kept = outcome(against_z[-1][1] < EVEN, lead[-1][1] > 2.0)
    else:
        text = "the lead of temporal volumes grows with the share of what moves."
        kept = outcome(lead[-1][1] > lead[0][1])
    return claim(text, kept, f"{grown}; {ahead}. The hierarchical Z-buffer is slower than the plain one {worse}."
                 + (" Where rooms are full, tbv is ahead of ours: movers hide movers there, and to portals they do not."
                    if any(b < EVEN for _, b in ours) else ""))


def proof_z(rows):
    parts = [row for row in rows if row["technique"] in ("hierarchical-z", "tbv")]
    if not parts:
        return ""
    looks = [number(row["vis_median_us"]) for row in parts if number(row["vis_median_us"]) is not None]
    loose = [number(row["overdraw"]) for row in parts if number(row["overdraw"]) is not None]
    listed = f"; objects listed for each that shows a pixel: {short(min(loose))} to {short(max(loose))}" if loose else ""
    return (f"<p>Of a frame of hierarchical-z and tbv, {short(min(looks))} to {short(max(looks))} µs are the walk through the "
            f"octree and the drawing of what hides{listed}.</p>")


def scenes(folder):
    """S3 to S6."""
    texts = [("S3", "static varies", "rooms", "rooms", "92 boxes move (1,100 polygons), static polygons vary (figure 6a)."),
             ("S3", "static varies, 100000 movers", "rooms", "rooms", "The same with 100,000 movers."),
             ("S4", "four a room", "rooms", "rooms, four movers each", "80 % of the scene moves (figure 6b)."),
             ("S5", "125 rooms", "movers", "movers", "125 rooms, movers vary, here up to a million (figure 6c).")]
    out = ["<h3>S3 to S5: Z-buffer, hierarchical Z-buffer, temporal bounding volumes</h3><p><i>zbuffer</i> moves everything and hands "
           "it on: what drawing it costs is not in its time, as it was in the paper. <i>hierarchical-z</i> and <i>tbv</i> cannot "
           "find what is visible without drawing what hides it; they do so on the processor, at the samples of a picture of "
           "1280×720, depths kept for tiles of 8×8, the octree updated from the root for every object. The curves of the paper are "
           "these three; beside them are portals with the tree updated for every object (<i>update-all</i>) and ours.</p>"]
    for name, scene, x, xlabel, text in texts:
        rows = [row for row in read(folder, name) if row["scene"] == scene]
        file = name + "-" + scene.replace(" ", "-").replace(",", "")
        out.append(f"<h3>{name}: {scene}</h3><p>{text}</p>" + section(folder, rows, file, f"{name}: {scene}", x, xlabel))
        out.append(figure_6(name, curves(rows, x, "mean_us"), "100000" in scene) + proof_z(rows) + proof(rows))
    out.append("<h3>S6: how long volumes are valid</h3><p>Discussed, not measured, in the paper. Cost against looseness: objects "
               "evaluated for each drawn. <i>constant</i> with periods of 1 to 1,024 ticks.</p>")
    for scene in ("still", "walk", "walk, 100000 movers"):
        rows = [row for row in read(folder, "S6") if row["scene"] == scene]
        lines = [[row["technique"] + (" " + row["period"] if row["technique"] == "constant" else ""),
                  short(number(row["median_us"])), short(number(row["mean_us"])), short(number(row["p99_us"])),
                  short(number(row["overdraw"])), short(number(row["reinserted"])), short(number(row["exposed"]))]
                 for row in rows]
        out.append(f"<h4>{scene}</h4>" + draw(folder, "S6-" + scene.replace(" ", "-").replace(",", ""), f"S6: {scene}",
                                              curves(rows, "overdraw", "mean_us"), "evaluated / drawn", "microseconds a frame, mean"))
        out.append(table(["policy", "median µs", "mean", "p99", "evaluated / drawn", "renewed a frame", "exposed a frame"], lines))
        best = {}
        for row in rows:
            if row["technique"] not in best or number(row["mean_us"]) < number(best[row["technique"]]["mean_us"]):
                best[row["technique"]] = row
        if "constant" in best and "reach" in best:
            mean = {t: number(row["mean_us"]) for t, row in best.items()}
            first = min(mean, key=mean.get)
            out.append(f"<p>The best constant period is {best['constant']['period']} ticks, {short(mean['constant'])} µs; reach needs "
                       f"{times(mean['reach'] / mean['constant'])} of that, and no period to be chosen. Fastest: {first}, "
                       f"{short(mean[first])} µs.</p>")
    return "".join(out)


THESIS = {"B1": ("Scene 1: one visible mover", "5.1–5.4"), "B2": ("Scene 2: one visible mover, the others hidden", "5.5–5.10"),
          "B3": ("Scene 3: visible and hidden movers, half each", "5.11–5.16"),
          "B4": ("Scene 4: the same with static objects too", "5.17–5.22")}
TESTS = [("test 1: polygons", "polygons", "polygons of a mover", "Test 1: number of polygons in a mover"),
         ("test 2: number", "movers", "number of movers", "Test 2: number of movers"),
         ("test 3: speed", "speed", "speed of the movers, metres a second", "Test 3: speed of the movers")]
# Of the thesis: frames a second and time a frame, over each of these. Scene 1 has no test of numbers.
FIGURES = {("B1", "polygons"): "5.1, 5.2", ("B1", "speed"): "5.3, 5.4", ("B2", "polygons"): "5.5, 5.6",
           ("B2", "movers"): "5.7, 5.8", ("B2", "speed"): "5.9, 5.10", ("B3", "polygons"): "5.11, 5.12",
           ("B3", "movers"): "5.13, 5.14", ("B3", "speed"): "5.15, 5.16", ("B4", "polygons"): "5.17, 5.18",
           ("B4", "movers"): "5.19, 5.20", ("B4", "speed"): "5.21, 5.22"}
MANY = ", 100000 movers"
CLAIMS = {"polygons": "volumes are ahead, the more so the more polygons a mover has.",
          "movers": "volumes are ahead, the more so the more movers there are.",
          "speed": "volumes are ahead, most with slow movers."}


def thesis_outcome(lines, x):
    """What became of a test's claim, in a word and with numbers: the first and the last of update-all / reach say which way the
    lead goes. Nothing if it was not measured."""
    points = ratio(lines, "update-all", "reach")
    if len(points) < 2:
        return None
    first, last = points[0][1], points[-1][1]
    trend = last < first if x == "speed" else last > first
    ahead = all(b >= EVEN for _, b in points)
    unit = {"polygons": "polygons", "movers": "movers", "speed": "m/s"}[x]
    found = f"{times(first)} as fast as portal culling at {short(points[0][0])} {unit}, {times(last)} at {short(points[-1][0])}"
    best = max(points, key=lambda p: p[1])
    found += f"; at most {times(best[1])}, at {short(best[0])}"
    behind = [f"{short(a)} ({times(b)})" for a, b in points if b < EVEN]
    found += f"; behind at {', '.join(behind)} {unit}." if behind else "; nowhere behind."
    return outcome(ahead, trend), found


def few_frames(rows, x):
    """Which values are the mean of so few frames that one more could move them: where a frame takes seconds."""
    few = [f"{row['technique']} at {short(number(row[x]))} ({row['frames']})" for row in rows if number(row["frames"]) < 10]
    return f"<p>Few frames, as each takes long: {', '.join(few)}.</p>" if few else ""


def thesis_table(folder):
    """The twelve tests at a glance."""
    lines = []
    for name, (title, _) in THESIS.items():
        rows = read(folder, name)
        for scene, x, _, heading in TESTS:
            for suffix in ("", MANY):
                found = thesis_outcome(curves([row for row in rows if row["scene"] == scene + suffix], x, "mean_us"), x)
                if found:
                    lines.append([title.split(":")[0], heading.split(":")[1].strip() + suffix.replace("100000", "100,000"),
                                  FIGURES.get((name, x), "–"), found[0], found[1]])
    return table(["scene", "varies", "figures of the thesis", "claim", "volumes (reach) here"], lines)


def thesis(folder):
    out = ["<h2>Paunoo 2006: the twelve tests</h2><p>Portal culling with every mover updated in the kd-tree (<i>update-all</i>) ",
           "against portal culling with dynamic bounding volumes. The tables and curves of the thesis are lost in our copy; its claims ",
           "stand here as its abstract and the titles of its figures have them, and so without factors of its own. The thesis stops at ",
           "ten movers; ours go on, and to speeds at which volumes lose. Scene 1 has no test of numbers in the thesis; here all its ",
           "movers are visible, up to 100,000 in a building of 16 rooms.</p>"]
    out.append(thesis_table(folder))
    for name, (title, figures) in THESIS.items():
        rows = read(folder, name)
        out.append(f"<h3>{title} (figures {figures})</h3>" + proof(rows))
        for scene, x, xlabel, heading in TESTS:
            for suffix in ("", MANY):
                part = [row for row in rows if row["scene"] == scene + suffix]
                if not part:
                    continue
                lines = curves(part, x, "mean_us")
                file = f"{name}-{x}" + ("-many" if suffix else "")
                more = "" if not suffix else ", 100,000 movers, all visible" if name == "B1" else ", 100,000 movers"
                caption = (title.split(":")[0] if suffix else title) + more
                found = thesis_outcome(lines, x)
                out.append(f"<h4>{heading}{more}</h4>" + section(folder, part, file, caption, x, xlabel) + few_frames(part, x))
                out.append((claim(CLAIMS[x], *found) if found else "") + verdict(lines, xlabel))
    out.append("<h3>The differences (figures 6.1 to 6.3)</h3><p>Time with portal culling alone over time with volumes (reach).</p>")
    for scene, x, xlabel, heading in TESTS:
        lines = {}
        for name in THESIS:
            part = [row for row in read(folder, name) if row["scene"] == scene]
            points = ratio(curves(part, x, "mean_us"), "update-all", "reach")
            if points:
                lines[name] = points
        out.append(f"<h4>{heading}</h4>" + draw(folder, "B-difference-" + x, heading, lines, xlabel,
                                                 "portal culling / volumes (update-all / reach)", True))
        out.append(values_table(lines, xlabel) if lines else "")
    return "".join(out)


def verdict(lines, xlabel):
    """Frames a second, and where volumes lose to whom."""
    words = []
    for base in ("update-all", "flat"):
        points = ratio(lines, base, "reach")
        if points:
            low, high = min(b for _, b in points), max(b for _, b in points)
            losing = [short(a) for a, b in points if b < EVEN]
            words.append(f"reach is {short(low)} to {short(high)} times as fast as {base}"
                         + (f"; <b>slower at {', '.join(losing)}</b> ({xlabel})" if losing else ""))
    fps = {t: [short(1e6 / b) for _, b in lines[t]] for t in ("update-all", "reach") if t in lines}
    frames = "; ".join(f"{t}: {', '.join(v)} frames/s" for t, v in fps.items())
    return f"<p>{'. '.join(words)}. {frames}.</p>"


def losing(folder):
    rows = read(folder, "losing")
    texts = [("fast movers", "speed", "metres a second", "Only a largest speed is known, and it is large: a volume that keeps off the "
              "seen cells is over in a tick, and renewing it costs more than moving the object."),
             ("open plan", "door_width", "door width, metres (rooms of 8 m)", "Doors in every wall, up to almost its width: more is "
              "seen, and hidden movers are never far from it."),
             ("all visible", "movers", "movers, all in the eye's room", "Nothing is hidden: volumes are only a burden.")]
    out = ["<h2>Where volumes lose</h2>"]
    for scene, x, xlabel, text in texts:
        part = [row for row in rows if row["scene"] == scene]
        out.append(f"<h3>{scene}</h3><p>{text}</p>")
        out.append(section(folder, part, "losing-" + scene.replace(" ", "-"), scene, x, xlabel))
        out.append(verdict(curves(part, x, "mean_us"), xlabel))
    return "".join(out) + proof(rows)


STYLE = """body{font:15px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}
table{border-collapse:collapse;margin:.5em 0 1em;font-size:13px}td,th{border:1px solid #ccc;padding:2px 7px;text-align:right}
th{background:#f2f2f2}.claim{background:#f4f7e8;padding:.4em .7em;border-left:4px solid #9b4}figure{margin:.5em 0}.missing{color:#a00}h2{border-top:2px solid #888;padding-top:.5em}"""
INTRO = """<h1>Moving objects: what was published, and what we measure</h1>
<p>Time of a frame: every motion that the technique evaluates, its index, and visibility, on one thread; drawing is apart. All
techniques of a table took turns in one run; curves and their tables are of the mean frame, in which rare dear frames count.
<b>zbuffer</b>: everything evaluated and handed on. <b>hierarchical-z</b>: Greene's hierarchical Z-buffer, on the processor, over
an octree in which every object is updated. <b>tbv</b>: temporal bounding volumes in that octree. <b>update-all</b>: every object
re-inserted in the kd-trees in every frame. <b>flat</b>: every object moved and kept in a list a room. <b>sweep</b>: every object
moved, all boxes tested eight at a time. <b>plain</b>: the least that finding can cost. <b>frustum</b>: kd-trees without portals.
<b>constant, adaptive, maximal, optimal, reach</b>: volumes with these validity periods. Every list was compared with brute force
(those of hierarchical-z and tbv with the pixels of a picture of everything); <i>lost</i> must be 0, <i>late</i> must be 0.</p>"""


def main():
    folder = pathlib.Path(sys.argv[1])
    parts = [sizes(folder), million(folder), updates(folder), scenes(folder), thesis(folder), losing(folder)]
    page = ("<!doctype html><html lang=en><head><meta charset=utf-8><title>Enfilade: moving objects</title>"
            f"<style>{STYLE}</style></head><body>{INTRO}{''.join(parts)}</body></html>\n")
    (folder / "report.html").write_text(page)
    print(folder / "report.html")


if __name__ == "__main__":
    main()

/* Links. Input: openings with the names that they give; output: source, target and orientation of each, or a warning and no opening.
 * Precedence: extras, then the name, then geometry (DESIGN §6). */
#include "compile/layout_work.h"

enum { CANDIDATES = 16 };

const char *enf_layout_cell_name(const EnfLayoutWork *work, uint32_t cell) {
    return cell < work->cells.count ? work->cells.data[cell].name : "nothing";
}

/* The room that a portal asks for, as text. */
typedef struct Wish {
    const char *text;
    size_t length;
    bool certain; /* given by extras or before a '*': it can mean nothing but a room */
} Wish;

/* Names that say what the thing is, not where it leads: `door-portal`, `window_02-portal`. */
static bool is_generic(const char *text, size_t length) {
    static const char *const words[] = {"portal", "door", "doorway", "opening", "window",
                                        "arch",   "gate", "passage", "hole",    "plane"};
    while (length > 0 && ((text[length - 1] >= '0' && text[length - 1] <= '9') || strchr("._- ", text[length - 1]) != NULL)) {
        length--;
    }
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (enf_name_compare(text, length, words[i], strlen(words[i]), true) == 0) {
            return true;
        }
    }
    return length == 0;
}

static Wish wish_of(const EnfLayoutWork *work, const EnfOpening *opening) {
    Wish wish = {"", 0, false};
    if (opening->extras == ENF_NONE) {
        return wish;
    }
    const EnfExtras *extras = &work->extras.data[opening->extras];
    if (extras->portal_to[0] != '\0') {
        return (Wish){extras->portal_to, strlen(extras->portal_to), true};
    }
    EnfNodeName name = enf_node_name(enf_opening_name(work, opening));
    if (name.suffix == ENF_SUFFIX_PORTAL) {
        wish = (Wish){name.text, name.target, name.starred && name.target > 0};
    }
    return wish;
}

static double axis_gap(double a_min, double a_max, double b_min, double b_max) {
    return a_min > b_max ? a_min - b_max : b_min > a_max ? b_min - a_max : 0.0;
}

static double box_distance(EnfBox3 a, EnfBox3 b) {
    return enf_length(enf_v3(axis_gap(a.min.x, a.max.x, b.min.x, b.max.x), axis_gap(a.min.y, a.max.y, b.min.y, b.max.y),
                             axis_gap(a.min.z, a.max.z, b.min.z, b.max.z)));
}

static EnfBox3 cell_box(const EnfLayoutWork *work, uint32_t cell) {
    return (EnfBox3){enf_grid_point(work->cells.data[cell].min), enf_grid_point(work->cells.data[cell].max)};
}

/* Of several rooms with one name, the one whose box is nearest to the opening. */
static uint32_t nearest_room(const EnfLayoutWork *work, const EnfOpening *opening, const uint32_t *cells, uint32_t count) {
    uint32_t best = ENF_NONE;
    double best_distance = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        double distance = box_distance(opening->patch.box, cell_box(work, cells[i]));
        bool nearer = best == ENF_NONE || distance < best_distance;
        if (nearer && (count == 1 || cells[i] != opening->source)) {
            best = cells[i];
            best_distance = distance;
        }
    }
    return best;
}

/* `Hall-room` means a node `Hall_room` too, and `Hall-room.001`. */
static size_t length_without_room(const char *text, size_t length) {
    bool suffixed = length > 5 && (text[length - 5] == '-' || text[length - 5] == '_') &&
                    enf_name_compare(text + length - 4, 4, "room", 4, true) == 0;
    return suffixed ? length - 5 : length;
}

static uint32_t find_room(const EnfLayoutWork *work, const EnfOpening *opening, const char *text, size_t length) {
    uint32_t cells[CANDIDATES];
    uint32_t count = enf_layout_find_rooms(work, text, length, cells, CANDIDATES);
    if (count == 0) {
        count = enf_layout_find_rooms(work, text, length_without_room(text, length), cells, CANDIDATES);
    }
    return nearest_room(work, opening, cells, count);
}

/* Where no surface says which side is which, the middles of the two boxes do. */
static double middles(const EnfLayoutWork *work, const EnfOpening *opening) {
    EnfVec3 from = opening->patch.centre, to = opening->patch.centre;
    if (opening->source != ENF_NONE) {
        EnfBox3 box = cell_box(work, opening->source);
        from = enf_scale(enf_add(box.min, box.max), 0.5);
    }
    if (opening->target != ENF_NONE) {
        EnfBox3 box = cell_box(work, opening->target);
        to = enf_scale(enf_add(box.min, box.max), 0.5);
    }
    return enf_dot(enf_sub(to, from), opening->patch.normal);
}

/* Does the front look into the source? The seams say, or else the surfaces ahead and behind, or else the boxes. Rays that pass through
 * a small target and end in the source again say little, so they need a margin, and the two cells must not contradict each other. */
static bool is_flipped(EnfLayoutWork *work, const EnfOpening *opening) {
    enum { MARGIN = 4 };
    const EnfPatch *patch = &opening->patch;
    double seams = enf_layout_seams(work, opening->source, patch) - enf_layout_seams(work, opening->target, patch);
    EnfVec3 size = enf_sub(patch->box.max, patch->box.min);
    double clear = 0.25 * enf_length(size); /* of a perimeter of at least twice the diagonal */
    if (seams > clear || seams < -clear) {
        return seams < 0.0;
    }
    for (int i = 0; i < 2; i++) {
        if (box_distance(patch->box, cell_box(work, i == 0 ? opening->source : opening->target)) > ENF_ROOM_REACH) {
            return false; /* rays from afar tell nothing: taken as given, and warned of as too far */
        }
    }
    EnfVec3 ahead = patch->normal, behind = enf_scale(ahead, -1.0);
    int source = enf_layout_side(work, opening->source, patch->centre, ahead) -
                 enf_layout_side(work, opening->source, patch->centre, behind);
    int target = enf_layout_side(work, opening->target, patch->centre, behind) -
                 enf_layout_side(work, opening->target, patch->centre, ahead);
    if (source == 0 && target == 0) {
        return middles(work, opening) < 0.0;
    }
    return source >= 0 && target >= 0 && source + target >= MARGIN;
}

/* Turns the polygon if its front looks into its source. A material's faces look anywhere, so they are turned in silence. */
static void orient(EnfLayoutWork *work, EnfOpening *opening) {
    opening->flipped = is_flipped(work, opening);
    if (opening->flipped && opening->extras != ENF_NONE) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_FLIPPED, enf_opening_name(work, opening),
                     "its front looks into its own room '%s'; it was turned around",
                     enf_layout_cell_name(work, opening->source));
        enf_opening_show(work, opening);
    }
}

static void drop(EnfLayoutWork *work, EnfOpening *opening) {
    opening->dropped = true;
    enf_opening_show(work, opening);
}

/* Nobody knows what is behind it, so whoever looks into the room is shown everything (PITFALLS 12, 17). */
static void drop_into_the_open(EnfLayoutWork *work, EnfOpening *opening) {
    drop(work, opening);
    work->cells.data[opening->source].flags |= ENF_CELL_OPEN;
}

/* A target by geometry, for an opening whose source is known. The polygon may be the wrong way round. */
static uint32_t target_by_geometry(EnfLayoutWork *work, EnfOpening *opening) {
    EnfVec3 normal = opening->patch.normal, back = enf_scale(normal, -1.0);
    bool turned = enf_layout_looks_into(work, &opening->patch, opening->source);
    return enf_layout_cell_on_side(work, &opening->patch, turned ? back : normal, opening->source);
}

static void link_inside(EnfLayoutWork *work, EnfOpening *opening, Wish wish) {
    const char *name = enf_opening_name(work, opening);
    opening->target = find_room(work, opening, wish.text, wish.length);
    if (opening->target == opening->source) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_SELF, name, "it leads from '%s' to itself; it was left out",
                     enf_layout_cell_name(work, opening->source));
        drop(work, opening);
        return;
    }
    if (opening->target == ENF_NONE) {
        opening->target = target_by_geometry(work, opening);
        bool named = wish.length > 0 && (wish.certain || !is_generic(wish.text, wish.length));
        if (opening->target == ENF_NONE) {
            enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_NO_TARGET, name,
                         "%s%.*s%s, and no room lies behind it; it was left out, and '%s' counts as open",
                         named ? "there is no room '" : "it names no room", named ? (int)wish.length : 0, wish.text,
                         named ? "'" : "", enf_layout_cell_name(work, opening->source));
            drop_into_the_open(work, opening);
            return;
        }
        if (named) {
            enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_NO_TARGET, name,
                         "there is no room '%.*s'; it was linked to '%s', which lies behind it", (int)wish.length, wish.text,
                         enf_layout_cell_name(work, opening->target));
            enf_opening_show(work, opening);
        }
    }
    orient(work, opening);
}

/* An opening outside every room's nodes: both sides by geometry, unless extras or name give one. */
static void link_loose(EnfLayoutWork *work, EnfOpening *opening, Wish wish) {
    EnfVec3 normal = opening->patch.normal, back = enf_scale(normal, -1.0);
    opening->target = find_room(work, opening, wish.text, wish.length);
    uint32_t ahead = ENF_NONE, behind = ENF_NONE;
    if (opening->target == ENF_NONE) {
        behind = enf_layout_cell_on_side(work, &opening->patch, back, ENF_NONE);
        ahead = enf_layout_cell_on_side(work, &opening->patch, normal, behind);
        opening->source = behind;
        opening->target = ahead;
    } else {
        bool turned = !enf_layout_looks_into(work, &opening->patch, opening->target);
        opening->source = enf_layout_cell_on_side(work, &opening->patch, turned ? normal : back, opening->target);
    }
    if (opening->source == ENF_NONE || opening->target == ENF_NONE) {
        uint32_t known = opening->source != ENF_NONE ? opening->source : opening->target;
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_OUTSIDE_ROOM, enf_opening_name(work, opening),
                     "it is in no room, and %s%s%s lies on its sides; it was left out",
                     known != ENF_NONE ? "only '" : "no room", known != ENF_NONE ? enf_layout_cell_name(work, known) : "",
                     known != ENF_NONE ? "'" : "");
        opening->source = known;
        if (known != ENF_NONE) {
            drop_into_the_open(work, opening);
        } else {
            drop(work, opening);
        }
        return;
    }
    orient(work, opening);
}

/* A polygon far from its rooms was misplaced, or put under the wrong one. */
static void warn_if_far(EnfLayoutWork *work, const EnfOpening *opening) {
    const uint32_t cells[2] = {opening->source, opening->target};
    for (int i = 0; i < (opening->has_transform ? 1 : 2); i++) {
        double distance = box_distance(opening->patch.box, cell_box(work, cells[i]));
        if (distance > ENF_ROOM_REACH) {
            enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_FAR, enf_opening_name(work, opening),
                         "it is %.1f m away from '%s', which it is to open", distance, enf_layout_cell_name(work, cells[i]));
            enf_opening_show(work, opening);
            return;
        }
    }
}

void enf_layout_link(EnfLayoutWork *work) {
    for (uint32_t i = 0; i < work->openings.count; i++) {
        EnfOpening *opening = &work->openings.data[i];
        if (opening->source == ENF_NONE && opening->extras != ENF_NONE) {
            const char *from = work->extras.data[opening->extras].from;
            opening->source = find_room(work, opening, from, strlen(from));
        }
    }
    enf_layout_teleports(work);
    for (uint32_t i = 0; i < work->openings.count; i++) {
        EnfOpening *opening = &work->openings.data[i];
        if (opening->dropped) {
            continue;
        }
        if (!opening->has_transform) {
            Wish wish = wish_of(work, opening);
            if (opening->source != ENF_NONE) {
                link_inside(work, opening, wish);
            } else {
                link_loose(work, opening, wish);
            }
        }
        if (!opening->dropped) {
            warn_if_far(work, opening);
        }
    }
    enf_layout_twins(work);
}

/* Makes the atlas of the font: a pen's way for each character, turned into distances to it. The design is our own: one stroke
 * width, round ends, curves of quadratic splines.
 *
 * A way is a list of strokes, separated by blanks; a stroke is a list of points, two characters each: x, then y, in base 36. A point
 * after '~' is a control point of a spline (two in a row mean a point midway). The base line is y = 4, small letters reach up to
 * y = 10 ('a'), capitals to y = 14 ('e'). */
#include <math.h>

#include "front/canvas.h"

typedef struct Glyph {
    int width;
    const char *way;
} Glyph;

static const Glyph glyphs[] = {
    {3, ""},                                                          /* ' ' */
    {0, "0e07 0404"},                                                 /* ! */
    {3, "0e0b 3e3b"},                                                 /* " */
    {8, "143e 547e 0b8b 0787"},                                       /* # */
    {8, "7c~6e4e~0e0b~0949~8987~8444~1406 4f43"},                     /* $ */
    {8, "048e 0c~0e2e~4e4c~4a2a~0a0c 46~4868~8886~8464~4446"},        /* % */
    {8, "842b~1e4e~7e5a~0806~0434~7489"},                             /* & */
    {0, "0e0b"},                                                      /* ' */
    {2, "2f~0d09~0522"},                                              /* ( */
    {2, "0f~2d29~2502"},                                              /* ) */
    {4, "2e28 0c4a 4c0a"},                                            /* * */
    {6, "0868 3b35"},                                                 /* + */
    {1, "1402"},                                                      /* , */
    {4, "0747"},                                                      /* - */
    {0, "0404"},                                                      /* . */
    {5, "025e"},                                                      /* / */
    {6, "09~0e3e~6e69~6434~0409"},                                    /* 0 */
    {6, "1c3e34"},                                                    /* 1 */
    {6, "0b~0e3e~6e6b~690464"},                                       /* 2 */
    {6, "0c~1e3e~6e~693929 39~69~6434~0406"},                         /* 3 */
    {6, "444e0767"},                                                  /* 4 */
    {6, "6e0e0a3a~6a~6434~0406"},                                     /* 5 */
    {6, "5e~0c07~0434~6467~6a3a~0a07"},                               /* 6 */
    {6, "0e6e24"},                                                    /* 7 */
    {6, "39~090b~0e3e~6e6b~6939 39~0906~0434~6466~6939"},             /* 8 */
    {6, "14~666b~6e3e~0e0b~0838~686b"},                               /* 9 */
    {0, "0909 0404"},                                                 /* : */
    {1, "1919 1402"},                                                 /* ; */
    {6, "6b0865"},                                                    /* < */
    {6, "0a6a 0666"},                                                 /* = */
    {6, "0b6805"},                                                    /* > */
    {6, "0b~0e3e~6e6b~693837 3434"},                                  /* ? */
    {9, "68~6b4b~2b28~2545~6568 6b66~6575~9599~9e5e~0e09~0353~7384"}, /* @ */
    {8, "044e84 2777"},                                               /* A */
    {8, "0949~89~844404 040e4e~7e~7949"},                             /* B */
    {8, "8b~7e4e~0e09~0444~7487"},                                    /* C */
    {8, "040e3e~8e89~843404"},                                        /* D */
    {7, "7e0e0474 0969"},                                             /* E */
    {7, "7e0e04 0969"},                                               /* F */
    {8, "8b~7e4e~0e09~0444~848959"},                                  /* G */
    {8, "040e 848e 0989"},                                            /* H */
    {0, "040e"},                                                      /* I */
    {5, "5e57~5424~0407"},                                            /* J */
    {7, "040e 7e08 3a74"},                                            /* K */
    {6, "0e0464"},                                                    /* L */
    {8, "040e478e84"},                                                /* M */
    {8, "040e848e"},                                                  /* N */
    {9, "09~0e4e~9e99~9454~0409"},                                    /* O */
    {8, "040e4e~8e~884808"},                                          /* P */
    {9, "09~0e4e~9e99~9454~0409 6794"},                               /* Q */
    {8, "040e4e~8e~884808 4884"},                                     /* R */
    {8, "7c~6e4e~0e0b~0949~8987~8444~1406"},                          /* S */
    {8, "0e8e 4e44"},                                                 /* T */
    {8, "0e08~0444~84888e"},                                          /* U */
    {8, "0e448e"},                                                    /* V */
    {12, "0e346d94ce"},                                               /* W */
    {8, "0e84 8e04"},                                                 /* X */
    {8, "0e498e 4944"},                                               /* Y */
    {8, "0e8e0484"},                                                  /* Z */
    {2, "2f0f0222"},                                                  /* [ */
    {5, "0e52"},                                                      /* \ */
    {2, "0f2f2202"},                                                  /* ] */
    {6, "0a3e6a"},                                                    /* ^ */
    {7, "0272"},                                                      /* _ */
    {2, "0e2c"},                                                      /* ` */
    {6, "6a64 67~6a3a~0a07~0434~6467"},                               /* a */
    {6, "0e04 07~0a3a~6a67~6434~0407"},                               /* b */
    {6, "69~5a3a~0a07~0434~5465"},                                    /* c */
    {6, "6e64 67~6a3a~0a07~0434~6467"},                               /* d */
    {6, "0767~6a3a~0a07~0434~5465"},                                  /* e */
    {4, "4e~1e1b14 0a3a"},                                            /* f */
    {6, "6a63~6030~1001 67~6a3a~0a07~0434~6467"},                     /* g */
    {6, "0e04 07~0a3a~6a6764"},                                       /* h */
    {0, "0a04 0d0d"},                                                 /* i */
    {2, "2a22~2000 2d2d"},                                            /* j */
    {6, "0e04 5a07 2864"},                                            /* k */
    {0, "0e04"},                                                      /* l */
    {10, "0a04 07~0a2a~5a5754 57~5a7a~aaa7a4"},                       /* m */
    {6, "0a04 07~0a3a~6a6764"},                                       /* n */
    {6, "07~0a3a~6a67~6434~0407"},                                    /* o */
    {6, "0a00 07~0a3a~6a67~6434~0407"},                               /* p */
    {6, "6a60 67~6a3a~0a07~0434~6467"},                               /* q */
    {4, "0a04 07~0a4a"},                                              /* r */
    {6, "69~5a3a~0a~0737~67~6434~1405"},                              /* s */
    {4, "1d16~1434 0a4a"},                                            /* t */
    {6, "0a07~0434~6467 6a64"},                                       /* u */
    {6, "0a346a"},                                                    /* v */
    {10, "0a345974aa"},                                               /* w */
    {6, "0a64 6a04"},                                                 /* x */
    {6, "0a34 6a10"},                                                 /* y */
    {6, "0a6a0464"},                                                  /* z */
    {3, "3f~1f1c~1909~1916~1232"},                                    /* { */
    {0, "0f02"},                                                      /* | */
    {3, "0f~2f2c~2939~2926~2202"},                                    /* } */
    {6, "07~1a38~5669"},                                              /* ~ */
};
_Static_assert(sizeof glyphs / sizeof *glyphs == 95, "the printable characters of ASCII");

enum { SEGMENTS_MAX = 160, SPLINE_STEPS = 8, MARGIN = 4 };

typedef struct Point {
    double x, y;
} Point;
typedef struct Way {
    Point ends[SEGMENTS_MAX][2];
    int count;
} Way;

double font_advance(char letter) {
    unsigned char code = (unsigned char)letter;
    if (code < 32 || code > 126) {
        code = '?';
    }
    return (double)glyphs[code - 32].width + 3.0;
}

static int digit(char c) {
    return c >= 'a' ? c - 'a' + 10 : c - '0';
}

static void add(Way *way, Point a, Point b) {
    if (way->count < SEGMENTS_MAX) {
        way->ends[way->count][0] = a;
        way->ends[way->count][1] = b;
        way->count++;
    }
}

static Point between(Point a, Point b, double t) {
    Point p = {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
    return p;
}

static void add_spline(Way *way, Point a, Point control, Point b) {
    Point last = a;
    for (int i = 1; i <= SPLINE_STEPS; i++) {
        double t = (double)i / SPLINE_STEPS;
        Point next = between(between(a, control, t), between(control, b, t), t);
        add(way, last, next);
        last = next;
    }
}

/* One stroke: on-curve points and control points as they come. */
static const char *add_stroke(Way *way, const char *at) {
    Point pen = {0.0, 0.0}, control = {0.0, 0.0};
    bool begun = false, curved = false;
    while (*at && *at != ' ') {
        bool is_control = *at == '~';
        at += is_control;
        Point p = {(double)digit(at[0]), (double)digit(at[1])};
        at += 2;
        if (is_control) {
            if (curved) {
                Point middle = between(control, p, 0.5);
                add_spline(way, pen, control, middle);
                pen = middle;
            }
            control = p;
            curved = true;
            continue;
        }
        if (curved) {
            add_spline(way, pen, control, p);
        } else if (begun) {
            add(way, pen, p);
        }
        pen = p;
        begun = true;
        curved = false;
    }
    return at;
}

static double distance2(Point p, Point a, Point b) {
    double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
    double t = length2 > 0.0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / length2 : 0.0;
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    Point q = between(a, b, t);
    return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
}

static uint8_t encode(double texels2) {
    double steps = 16.0 * sqrt(texels2);
    return steps >= 255.0 ? 255 : (uint8_t)floor(steps + 0.5);
}

static void draw_tile(uint8_t *atlas, int number, const Way *way) {
    int left = number % FONT_COLUMNS * FONT_TILE_WIDTH, top = number / FONT_COLUMNS * FONT_TILE_HEIGHT;
    for (int y = 0; y < FONT_TILE_HEIGHT; y++) {
        for (int x = 0; x < FONT_TILE_WIDTH; x++) {
            Point p = {(x + 0.5 - MARGIN) / FONT_UNIT, (FONT_TILE_HEIGHT - MARGIN - y - 0.5) / FONT_UNIT};
            double best = 1e9;
            for (int i = 0; i < way->count; i++) {
                double d2 = distance2(p, way->ends[i][0], way->ends[i][1]);
                best = d2 < best ? d2 : best;
            }
            atlas[(top + y) * FONT_ATLAS_WIDTH + left + x] = encode(best * FONT_UNIT * FONT_UNIT);
        }
    }
}

void font_draw_atlas(uint8_t *atlas) {
    for (int i = 0; i < 95; i++) {
        Way way = {.count = 0};
        const char *at = glyphs[i].way;
        while (*at) {
            at = add_stroke(&way, at);
            at += *at == ' ';
        }
        draw_tile(atlas, i, &way);
    }
    Way line = {.count = 0};
    int half = FONT_TILE_HEIGHT / 2;
    double middle = (half - MARGIN) / FONT_UNIT;
    add(&line, (Point){-20.0, middle}, (Point){40.0, middle});
    draw_tile(atlas, 95, &line);
}

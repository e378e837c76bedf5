/* EnfSoup: every drawable static triangle of a level in the world, on the grid, watertight.
 *
 * Vertices are snapped once to 2^-12 m (DESIGN §2); afterwards equal positions are equal integers, degenerate triangles are
 * dropped, and T-junctions are mended: a vertex lying on another triangle's edge splits that triangle, so that rasterised
 * neighbours share edges and no pixel looks through a crack (PITFALLS 14). */
#ifndef ENFILADE_COMPILE_SOUP_H
#define ENFILADE_COMPILE_SOUP_H

#include "compile/layout.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct EnfSoupVertex {
    EnfGrid3 p;
    float normal[3], uv[2], color[4]; /**< colour linear */
} EnfSoupVertex;

typedef struct EnfSoupTriangle {
    uint32_t v[3]; /**< in vertices; vertices are shared within one node's primitive only */
    uint32_t material;
    uint32_t node; /**< source node */
    uint32_t cell; /**< home, ENF_NONE while loose */
} EnfSoupTriangle;

typedef struct EnfSoup {
    EnfSoupVertex *vertices;
    uint32_t vertex_count;
    EnfSoupTriangle *triangles;
    uint32_t triangle_count;
    uint32_t source_triangle_count; /**< drawn ones, before dropping and splitting */
    uint32_t degenerate_count, split_count;
} EnfSoup;

/** Bakes nodes with ENF_ROLE_GEOMETRY. Mirrored (negative determinant) nodes have their winding restored. nodraw and caulk
 *  materials are left out of drawing but kept where they close a shell (flag by material). */
EnfResult enf_soup_build(EnfSoup *soup, const EnfSource *source, const EnfLayout *layout, const EnfCompileSettings *settings,
                         EnfDiagnosis *diagnosis, EnfError *error);
void enf_soup_free(EnfSoup *soup);

#ifdef __cplusplus
}
#endif
#endif

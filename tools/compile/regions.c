/* Regions: what can be said about cells only once every triangle is known. Input: layout and soup; output: homes for loose triangles,
 * the OUTSIDE cell, final bounds, links between cells that share space, and flags on those that are not closed. */
#include "compile/regions.h"

static int64_t least(int64_t a, int64_t b) {
    return a < b ? a : b;
}

static int64_t most(int64_t a, int64_t b) {
    return a > b ? a : b;
}

/* Loose triangles have joined: the bounds take them in. */
static void extend_bounds(EnfRegions *regions) {
    const EnfSoup *soup = regions->soup;
    for (uint32_t i = 0; i < soup->triangle_count; i++) {
        const EnfSoupTriangle *triangle = &soup->triangles[i];
        EnfLayoutCell *cell = &regions->layout->cells[triangle->cell];
        for (int k = 0; k < 3; k++) {
            EnfGrid3 p = soup->vertices[triangle->v[k]].p;
            cell->min = (EnfGrid3){least(cell->min.x, p.x), least(cell->min.y, p.y), least(cell->min.z, p.z)};
            cell->max = (EnfGrid3){most(cell->max.x, p.x), most(cell->max.y, p.y), most(cell->max.z, p.z)};
        }
    }
}

EnfResult enf_regions_assign(EnfLayout *layout, struct EnfSoup *soup, const EnfSource *source,
                             const EnfCompileSettings *settings, EnfDiagnosis *diagnosis) {
    ENF_ASSERT(layout && soup && source && settings && diagnosis);
    EnfRegions regions = {layout, soup, source, settings, diagnosis};
    EnfSpace space = {0};
    if (!enf_regions_loose(&regions)) {
        return ENF_ERROR_MEMORY;
    }
    extend_bounds(&regions);
    if (layout->cell_count < 2) {
        return ENF_OK; /* one cell has no borders to be wrong about */
    }
    bool ok = enf_space_create(&space, layout, soup);
    ok = ok && (!settings->detect_leaks || enf_regions_leaks(&regions, &space)) && enf_regions_overlaps(&regions, &space);
    enf_space_free(&space);
    return ok ? ENF_OK : ENF_ERROR_MEMORY;
}

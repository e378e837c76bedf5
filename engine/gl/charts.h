/* EnfGlCharts: the large flat surfaces of a map, and where each lies in one light map. Pure data, no GL call. */
#ifndef ENFILADE_GL_CHARTS_H
#define ENFILADE_GL_CHARTS_H

#include <enfilade/map.h>

/** Light maps have texels at the points of a lattice of `step` in the cell's coordinates, so charts that meet in a plane
 *  share their samples and no seam shows. */
typedef struct EnfGlChart {
    uint32_t cluster;
    float normal[3];   /**< unit */
    float distance;    /**< normal·p of its plane, relative to the home cell's origin */
    uint32_t axis;     /**< the axis along which it is projected: of the normal's largest component */
    float step;        /**< metres a texel */
    int32_t first[2];  /**< lattice coordinates of its first texel along the two other axes */
    uint32_t size[2];  /**< texels */
    uint32_t place[2]; /**< of its first texel in the light map */
} EnfGlChart;

typedef struct EnfGlCharts {
    EnfGlChart *charts;
    uint32_t *vertex_charts; /**< a vertex's chart, or ENF_NONE: lit by the vertex */
    uint32_t count, capacity, vertex_count;
    uint32_t width, height; /**< of the light map; its first 2 × 2 texels are no chart's */
} EnfGlCharts;

/** None in a map without lamps, whose light does not vary over a plane. Texels a metre are halved until the light map fits into `max_size`². Free with enf_gl_charts_free, also after a failure. */
EnfResult enf_gl_charts_build(EnfGlCharts *charts, const EnfMap *map, uint32_t max_size, EnfError *error);
void enf_gl_charts_free(EnfGlCharts *charts);

/** The two axes that a chart's texels run along. */
static inline uint32_t enf_gl_chart_axis(const EnfGlChart *chart, uint32_t i) {
    return (chart->axis + 1 + i) % 3;
}

#endif

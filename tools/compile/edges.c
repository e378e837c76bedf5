/* Edges of an EnfSoup: positions are numbered through a hash table, then every edge is put under the smaller of its two
 * position numbers, where the edges with the same ends meet. */
#include "compile/edges.h"

#include "compile/exact.h"

#include <stdlib.h>
#include <string.h>

/* ---- positions -------------------------------------------------------------------------------------------------- */

static uint64_t hash_point(EnfGrid3 p) {
    uint64_t h = (uint64_t)p.x * UINT64_C(0x9e3779b97f4a7c15) ^ (uint64_t)p.y * UINT64_C(0xc2b2ae3d27d4eb4f) ^
                 (uint64_t)p.z * UINT64_C(0x165667b19e3779f9);
    h ^= h >> 32;
    h *= UINT64_C(0xd6e8feb86659fd93);
    return h ^ h >> 29;
}

static void number_positions(EnfEdges *edges, const EnfSoup *soup, uint32_t *table, uint64_t mask) {
    for (uint32_t i = 0; i < soup->vertex_count; i++) {
        EnfGrid3 p = soup->vertices[i].p;
        uint64_t slot = hash_point(p) & mask;
        while (table[slot] != ENF_NONE && !enf_grid_equal(edges->points[table[slot]], p)) {
            slot = (slot + 1) & mask;
        }
        if (table[slot] == ENF_NONE) {
            table[slot] = edges->point_count;
            edges->points[edges->point_count++] = p;
        }
        edges->position[i] = table[slot];
    }
}

static bool find_positions(EnfEdges *edges, const EnfSoup *soup) {
    uint64_t size = 16;
    while (size < (uint64_t)soup->vertex_count * 2) {
        size *= 2;
    }
    uint32_t *table = malloc((size_t)size * sizeof *table);
    edges->position = malloc(((size_t)soup->vertex_count + 1) * sizeof *edges->position);
    edges->points = malloc(((size_t)soup->vertex_count + 1) * sizeof *edges->points);
    bool ok = table && edges->position && edges->points;
    if (ok) {
        memset(table, 0xff, (size_t)size * sizeof *table);
        number_positions(edges, soup, table, size - 1);
    }
    free(table);
    return ok;
}

/* ---- matching --------------------------------------------------------------------------------------------------- */

/* An edge seen from its smaller end. */
typedef struct HalfEdge {
    uint32_t other; /* the larger position number */
    uint32_t cell;
    uint32_t ref;    /* triangle * 4 + corner */
    int32_t balance; /* +1 if it runs from the smaller to the larger number, -1 if back */
} HalfEdge;

static int compare_half_edges(const void *left, const void *right) {
    const HalfEdge *a = left, *b = right;
    if (a->other != b->other) {
        return a->other < b->other ? -1 : 1;
    }
    if (a->cell != b->cell) {
        return a->cell < b->cell ? -1 : 1;
    }
    return (a->ref > b->ref) - (a->ref < b->ref);
}

static void sort_few(HalfEdge *edges, uint32_t count) {
    if (count > 24) {
        qsort(edges, count, sizeof *edges, compare_half_edges);
        return;
    }
    for (uint32_t i = 1; i < count; i++) {
        HalfEdge moved = edges[i];
        uint32_t j = i;
        for (; j > 0 && compare_half_edges(&edges[j - 1], &moved) > 0; j--) {
            edges[j] = edges[j - 1];
        }
        edges[j] = moved;
    }
}

static HalfEdge half_edge(const EnfEdges *edges, const EnfSoup *soup, uint32_t triangle, uint32_t corner, uint32_t *smaller) {
    const EnfSoupTriangle *t = &soup->triangles[triangle];
    uint32_t a = edges->position[t->v[corner]], b = edges->position[t->v[(corner + 1) % 3]];
    *smaller = a < b ? a : b;
    return (HalfEdge){a < b ? b : a, t->cell, triangle * 4 + corner, a < b ? 1 : -1};
}

/* Puts every edge under its smaller position: bucket i is sorted[first[i] .. first[i + 1]). */
static void fill_buckets(const EnfEdges *edges, const EnfSoup *soup, HalfEdge *sorted, uint32_t *first) {
    uint32_t smaller;
    memset(first, 0, ((size_t)edges->point_count + 2) * sizeof *first);
    for (uint32_t t = 0; t < soup->triangle_count; t++) {
        for (uint32_t corner = 0; corner < 3; corner++) {
            half_edge(edges, soup, t, corner, &smaller);
            first[smaller + 2]++;
        }
    }
    for (uint32_t i = 2; i < edges->point_count + 2; i++) {
        first[i] += first[i - 1];
    }
    for (uint32_t t = 0; t < soup->triangle_count; t++) {
        for (uint32_t corner = 0; corner < 3; corner++) {
            HalfEdge edge = half_edge(edges, soup, t, corner, &smaller);
            sorted[first[smaller + 1]++] = edge;
        }
    }
}

/* Marks the edges of one bucket whose runs of equal ends and cell do not balance. */
static uint32_t mark_open(HalfEdge *bucket, uint32_t count, uint8_t *open) {
    uint32_t marked = 0;
    sort_few(bucket, count);
    for (uint32_t first = 0, end; first < count; first = end) {
        int32_t balance = 0;
        for (end = first; end < count && bucket[end].other == bucket[first].other && bucket[end].cell == bucket[first].cell;
             end++) {
            balance += bucket[end].balance;
        }
        for (uint32_t i = first; i < end && balance != 0; i++) {
            open[bucket[i].ref / 4] |= (uint8_t)(1u << (bucket[i].ref % 4));
            marked++;
        }
    }
    return marked;
}

static bool list_open(EnfEdges *edges, const EnfSoup *soup, const uint8_t *open, uint32_t open_count) {
    edges->open = malloc(((size_t)open_count + 1) * sizeof *edges->open);
    if (!edges->open) {
        return false;
    }
    for (uint32_t t = 0; t < soup->triangle_count; t++) {
        for (uint32_t corner = 0; corner < 3; corner++) {
            if (open[t] >> corner & 1) {
                edges->open[edges->open_count++] = (EnfEdgeRef){t, corner};
            }
        }
    }
    return true;
}

static bool find_open(EnfEdges *edges, const EnfSoup *soup) {
    HalfEdge *sorted = malloc(((size_t)soup->triangle_count * 3 + 1) * sizeof *sorted);
    uint32_t *first = malloc(((size_t)edges->point_count + 2) * sizeof *first);
    uint8_t *open = calloc((size_t)soup->triangle_count + 1, 1);
    bool ok = sorted && first && open;
    if (ok) {
        uint32_t open_count = 0;
        fill_buckets(edges, soup, sorted, first);
        for (uint32_t i = 0; i < edges->point_count; i++) {
            open_count += mark_open(sorted + first[i], first[i + 1] - first[i], open);
        }
        ok = list_open(edges, soup, open, open_count);
    }
    free(sorted);
    free(first);
    free(open);
    return ok;
}

EnfResult enf_edges_find(EnfEdges *edges, const EnfSoup *soup, EnfError *error) {
    memset(edges, 0, sizeof *edges);
    if (!find_positions(edges, soup) || !find_open(edges, soup)) {
        enf_edges_free(edges);
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for the edges of %u triangles",
                             soup->triangle_count);
    }
    return ENF_OK;
}

void enf_edges_free(EnfEdges *edges) {
    free(edges->position);
    free(edges->points);
    free(edges->open);
    memset(edges, 0, sizeof *edges);
}

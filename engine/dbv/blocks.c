/* The boxes of volumes where they hang: a list of SoA blocks a place, so that a seen place is read in a row and tested eight boxes
 * at a time, and no volume's record is touched unless its box passes. Only the first block of a place has free lanes: what is
 * taken out is replaced by the last one in. Blocks come from chunks that are never given back, so a warm frame makes no heap
 * call. */
#include "dbv/dbv_internal.h"

#include <math.h>
#include <string.h>

_Static_assert(offsetof(EnfDbvBlock, boxes) == 0, "enf_simd's boxes are a block's");

void enf_dbv_pool_destroy(EnfDbvPool *pool, const EnfAllocator *allocator) {
    for (uint32_t c = 0; c < pool->chunk_count; c++) {
        enf_free(allocator, pool->chunks[c], ENF_DBV_CHUNK, sizeof *pool->chunks[c]);
    }
    enf_free(allocator, pool->chunks, pool->chunk_capacity, sizeof *pool->chunks);
}

static bool add_chunk(EnfDbvIndex *index) {
    EnfDbvPool *pool = &index->pool;
    if (pool->chunk_count == pool->chunk_capacity) {
        uint32_t capacity = pool->chunk_capacity == 0 ? 16 : pool->chunk_capacity * 2;
        EnfDbvBlock **chunks = enf_alloc(index->allocator, capacity, sizeof *chunks);
        if (chunks == NULL) {
            return false;
        }
        if (pool->chunk_count > 0) {
            memcpy(chunks, pool->chunks, pool->chunk_count * sizeof *chunks);
        }
        enf_free(index->allocator, pool->chunks, pool->chunk_capacity, sizeof *chunks);
        pool->chunks = chunks;
        pool->chunk_capacity = capacity;
    }
    EnfDbvBlock *blocks = enf_alloc(index->allocator, ENF_DBV_CHUNK, sizeof *blocks);
    if (blocks == NULL) {
        return false;
    }
    pool->chunks[pool->chunk_count++] = blocks;
    return true;
}

/* An empty block, or ENF_NONE without memory. */
static uint32_t take_block(EnfDbvIndex *index) {
    EnfDbvPool *pool = &index->pool;
    uint32_t number = pool->free_head;
    if (number != ENF_NONE) {
        pool->free_head = enf_dbv_block(pool, number)->next;
    } else {
        if (pool->used == pool->chunk_count * ENF_DBV_CHUNK && !add_chunk(index)) {
            return ENF_NONE;
        }
        number = pool->used++;
    }
    EnfDbvBlock *block = enf_dbv_block(pool, number);
    memset(block->boxes.item, 0xff, sizeof block->boxes.item); /* ENF_NONE */
    block->count = 0;
    return number;
}

/* What reaches beyond every cell is told apart no further: a far coordinate would bring its rounding into the test of planes. */
static float far_low(const EnfDbvPool *pool, float x) {
    return (double)x < -pool->bound ? -INFINITY : x;
}

static float far_high(const EnfDbvPool *pool, float x) {
    return (double)x > pool->bound ? INFINITY : x;
}

static void set_lane(const EnfDbvPool *pool, EnfKdBlock *boxes, uint32_t lane, EnfBox3f box) {
    boxes->min_x[lane] = far_low(pool, box.min.x);
    boxes->min_y[lane] = far_low(pool, box.min.y);
    boxes->min_z[lane] = far_low(pool, box.min.z);
    boxes->max_x[lane] = far_high(pool, box.max.x);
    boxes->max_y[lane] = far_high(pool, box.max.y);
    boxes->max_z[lane] = far_high(pool, box.max.z);
}

bool enf_dbv_link(EnfDbvIndex *index, uint32_t object, uint32_t place, EnfBox3f box) {
    EnfDbvPool *pool = &index->pool;
    EnfDbvVolume *volume = &index->volumes[object];
    uint32_t head = index->places.heads[place];
    if (head == ENF_NONE || enf_dbv_block(pool, head)->count == ENF_KD_BLOCK) {
        uint32_t fresh = take_block(index);
        if (fresh == ENF_NONE) {
            return false;
        }
        enf_dbv_block(pool, fresh)->next = head;
        enf_dbv_block(pool, fresh)->place = place;
        index->places.heads[place] = fresh;
        head = fresh;
    }
    EnfDbvBlock *block = enf_dbv_block(pool, head);
    uint32_t lane = block->count++;
    set_lane(pool, &block->boxes, lane, box);
    block->boxes.item[lane] = object * ENF_DBV_LINKS + volume->link_count;
    volume->links[volume->link_count++] = head * ENF_KD_BLOCK + lane;
    return true;
}

void enf_dbv_relink(EnfDbvIndex *index, uint32_t object, EnfBox3f box) {
    uint32_t slot = index->volumes[object].links[0];
    set_lane(&index->pool, &enf_dbv_block(&index->pool, slot / ENF_KD_BLOCK)->boxes, slot % ENF_KD_BLOCK, box);
}

static float higher(float a, float b) {
    return a > b ? a : b;
}

static float lower(float a, float b) {
    return a < b ? a : b;
}

void enf_dbv_cut(EnfDbvIndex *index, uint32_t slot, EnfBox3f by) {
    EnfDbvBlock *block = enf_dbv_block(&index->pool, slot / ENF_KD_BLOCK);
    EnfBox3f old = enf_dbv_lane(&block->boxes, slot % ENF_KD_BLOCK);
    EnfBox3f box = {{higher(old.min.x, by.min.x), higher(old.min.y, by.min.y), higher(old.min.z, by.min.z)},
                    {lower(old.max.x, by.max.x), lower(old.max.y, by.max.y), lower(old.max.z, by.max.z)}};
    bool some = box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z;
    if (some) { /* else the object is elsewhere, and its other boxes tell: this one stays */
        set_lane(&index->pool, &block->boxes, slot % ENF_KD_BLOCK, box);
        if (block->place < index->places.nodes_first) {
            index->places.fits[block->place].loose = true;
        }
    }
}

static void copy_lane(EnfKdBlock *to, uint32_t a, const EnfKdBlock *from, uint32_t b) {
    to->min_x[a] = from->min_x[b];
    to->min_y[a] = from->min_y[b];
    to->min_z[a] = from->min_z[b];
    to->max_x[a] = from->max_x[b];
    to->max_y[a] = from->max_y[b];
    to->max_z[a] = from->max_z[b];
    to->item[a] = from->item[b];
}

uint32_t enf_dbv_unlink(EnfDbvIndex *index, uint32_t slot) {
    EnfDbvPool *pool = &index->pool;
    EnfDbvBlock *block = enf_dbv_block(pool, slot / ENF_KD_BLOCK);
    uint32_t place = block->place;
    uint32_t head = index->places.heads[place];
    EnfDbvBlock *first = enf_dbv_block(pool, head);
    uint32_t last = --first->count;
    if (block != first || slot % ENF_KD_BLOCK != last) {
        uint32_t moved = first->boxes.item[last];
        copy_lane(&block->boxes, slot % ENF_KD_BLOCK, &first->boxes, last);
        index->volumes[moved / ENF_DBV_LINKS].links[moved % ENF_DBV_LINKS] = slot;
    }
    first->boxes.item[last] = ENF_NONE;
    if (first->count == 0) {
        index->places.heads[place] = first->next;
        first->next = pool->free_head;
        pool->free_head = head;
    }
    return place;
}

EnfBox3f enf_dbv_lane(const EnfKdBlock *boxes, uint32_t lane) {
    EnfBox3f box = {{boxes->min_x[lane], boxes->min_y[lane], boxes->min_z[lane]},
                    {boxes->max_x[lane], boxes->max_y[lane], boxes->max_z[lane]}};
    return box;
}

size_t enf_dbv_pool_bytes(const EnfDbvPool *pool) {
    return (size_t)pool->chunk_count * ENF_DBV_CHUNK * sizeof(EnfDbvBlock) + pool->chunk_capacity * sizeof(EnfDbvBlock *);
}

/* Boxes in blocks are in world coordinates; a pyramid comes relative to its cell's origin. Moved there, it is opened by what
 * rounding may do on either side: five roundings of 2^-24 of each product, here and in the test of an object's own box, whose
 * coordinates are below `bound` (beyond it they are infinite and pass) or twice that relative to a cell. Looser, never tighter:
 * what is drawn is decided by the object's own box. */
void enf_dbv_planes(const EnfDbvIndex *index, uint32_t cell, const EnfPyramid *pyramid, EnfSimdPlanes *out) {
    const double *origin = index->map->cells[cell].origin;
    enf_simd_planes(out, pyramid);
    for (uint32_t i = 0; i < out->count; i++) {
        double nx = (double)out->nx[i];
        double ny = (double)out->ny[i];
        double nz = (double)out->nz[i];
        double d = (double)out->d[i];
        double moved = d - (nx * origin[0] + ny * origin[1] + nz * origin[2]);
        double size = (fabs(nx) + fabs(ny) + fabs(nz)) * 2.0 * index->pool.bound + fabs(d) + fabs(moved);
        out->d[i] = (float)(moved + 0x1p-20 * size);
    }
}

/* What every query relies on, checked on untrusted arrays in one pass in pre-order. */
#include <enfilade/kd.h>

#include <float.h>

/* A right child still to come: where it must be, and beneath what. */
typedef struct Due {
    uint32_t node, parent, depth;
} Due;

typedef struct KdCheck {
    const EnfKdTree *tree;
    uint32_t item_count, next_block;
    EnfError *error;
} KdCheck;

static EnfResult bad(const KdCheck *c, EnfResult code, const char *what, uint32_t index, const char *field) {
    return enf_error_set(c->error, code, UINT64_MAX, "kd %s %u: %s", what, index, field);
}

/* Finite and not empty. */
static bool proper(const float *min, const float *max) {
    for (int axis = 0; axis < 3; axis++) {
        if (!(min[axis] >= -FLT_MAX && min[axis] <= max[axis] && max[axis] <= FLT_MAX)) {
            return false;
        }
    }
    return true;
}

static bool within(const float *min, const float *max, const EnfKdNode *outer) {
    bool inside = true;
    for (int axis = 0; axis < 3; axis++) {
        inside = inside && min[axis] >= outer->min[axis] && max[axis] <= outer->max[axis];
    }
    return inside;
}

static EnfResult check_block(KdCheck *c, uint32_t index, const EnfKdNode *leaf) {
    const EnfKdBlock *b = &c->tree->blocks[index];
    for (uint32_t i = 0; i < ENF_KD_BLOCK; i++) {
        const float min[3] = {b->min_x[i], b->min_y[i], b->min_z[i]}, max[3] = {b->max_x[i], b->max_y[i], b->max_z[i]};
        if (b->item[i] == ENF_NONE) {
            for (int axis = 0; axis < 3; axis++) {
                if (min[axis] != FLT_MAX || max[axis] != -FLT_MAX) {
                    return bad(c, ENF_ERROR_FORMAT, "block", index, "an unused lane does not hold the empty box");
                }
            }
        } else if (b->item[i] >= c->item_count) {
            return bad(c, ENF_ERROR_INDEX, "block", index, "item is outside its table");
        } else if (!proper(min, max)) {
            return bad(c, ENF_ERROR_RANGE, "block", index, "a box is empty or not finite");
        } else if (!within(min, max, leaf)) {
            return bad(c, ENF_ERROR_RANGE, "block", index, "a box sticks out of its leaf");
        }
    }
    return ENF_OK;
}

static EnfResult check_leaf(KdCheck *c, uint32_t index) {
    const EnfKdNode *leaf = &c->tree->nodes[index];
    if (leaf->link != c->next_block) {
        return bad(c, ENF_ERROR_FORMAT, "node", index, "link: the leaf's blocks do not follow those of the leaf before it");
    }
    if (leaf->block_count > c->tree->block_count - c->next_block) {
        return bad(c, ENF_ERROR_INDEX, "node", index, "block_count reaches beyond the blocks");
    }
    for (uint32_t i = 0; i < leaf->block_count; i++) {
        EnfResult result = check_block(c, c->next_block + i, leaf);
        if (result) {
            return result;
        }
    }
    c->next_block += leaf->block_count;
    return ENF_OK;
}

static EnfResult check_node(KdCheck *c, const Due *at) {
    const EnfKdNode *node = &c->tree->nodes[at->node];
    if (!proper(node->min, node->max)) {
        return bad(c, ENF_ERROR_RANGE, "node", at->node, "min, max: empty or not finite");
    }
    if (at->parent != ENF_NONE && !within(node->min, node->max, &c->tree->nodes[at->parent])) {
        return bad(c, ENF_ERROR_RANGE, "node", at->node, "min, max: sticks out of its parent");
    }
    if (node->block_count) {
        return check_leaf(c, at->node);
    }
    if (node->link <= at->node + 1 || node->link >= c->tree->node_count) {
        return bad(c, ENF_ERROR_INDEX, "node", at->node, "link: the right child does not lie behind the left one");
    }
    if (at->depth >= ENF_KD_MAX_DEPTH) {
        return bad(c, ENF_ERROR_RANGE, "node", at->node, "deeper than a tree may be");
    }
    return ENF_OK;
}

EnfResult enf_kd_check(const EnfKdTree *tree, uint32_t item_count, EnfError *error) {
    KdCheck c = {tree, item_count, 0, error};
    Due due[ENF_KD_MAX_DEPTH + 1];
    Due at = {0, ENF_NONE, 0};
    uint32_t due_count = 0;
    for (uint32_t i = 0; i < tree->node_count; i++) {
        if (at.node != i) {
            return bad(&c, ENF_ERROR_FORMAT, "node", i, "link: nodes are not in depth-first order");
        }
        EnfResult result = check_node(&c, &at);
        if (result) {
            return result;
        }
        if (!tree->nodes[i].block_count) {
            due[due_count++] = (Due){tree->nodes[i].link, i, at.depth + 1};
            at = (Due){i + 1, i, at.depth + 1};
        } else if (due_count) {
            at = due[--due_count];
        } else if (i + 1 != tree->node_count) {
            return bad(&c, ENF_ERROR_FORMAT, "node", i + 1, "belongs to no parent");
        } else {
            at.node = tree->node_count;
        }
    }
    if (at.node != tree->node_count) {
        return bad(&c, ENF_ERROR_TRUNCATED, "node", at.node, "is missing");
    }
    if (c.next_block != tree->block_count) {
        return bad(&c, ENF_ERROR_FORMAT, "block", c.next_block, "belongs to no leaf");
    }
    return ENF_OK;
}

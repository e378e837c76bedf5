/* EnfGltf: a glTF document as plain arrays, read by tinygltf behind this header; nothing else in the project sees it.
 *
 * Every index has been checked by enf_gltf_check before tinygltf saw the text. Numbers are as written; strings live as long as
 * the document. Buffers and images are not here: tinygltf would open files and decode as it parses (import_buffer.c does). */
#ifndef ENFILADE_COMPILE_GLTF_WRAP_H
#define ENFILADE_COMPILE_GLTF_WRAP_H

#include <enfilade/base.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ENF_GLTF_UV_SETS = 8 };

/** EXT_meshopt_compression of a view; `count` 0 where there is none. */
typedef struct EnfGltfMeshopt {
    uint32_t buffer, stride;
    uint64_t offset, length, count;
    const char *mode, *filter;
} EnfGltfMeshopt;

typedef struct EnfGltfView {
    uint32_t buffer, stride; /**< stride 0: tight */
    uint64_t offset, length;
    EnfGltfMeshopt meshopt;
} EnfGltfView;

typedef struct EnfGltfSparse {
    uint64_t count; /**< 0: not sparse */
    uint32_t index_view, index_type, value_view;
    uint64_t index_offset, value_offset;
} EnfGltfSparse;

typedef struct EnfGltfAccessor {
    uint32_t view; /**< or ENF_NONE: zeros */
    uint32_t component_type, components;
    bool normalized;
    uint64_t offset, count;
    EnfGltfSparse sparse;
} EnfGltfAccessor;

/** Accessor indices, or ENF_NONE. */
typedef struct EnfGltfPrimitive {
    uint32_t position, normal, color, uv[ENF_GLTF_UV_SETS], indices;
    uint32_t material, mode;
    bool morphed;
} EnfGltfPrimitive;

typedef struct EnfGltfMesh {
    const char *name;
    uint32_t primitive_first, primitive_count;
} EnfGltfMesh;

typedef struct EnfGltfNode {
    const char *name;
    uint32_t child_first, child_count; /**< in links */
    uint32_t mesh, camera, light;
    uint32_t instance_translation, instance_rotation, instance_scale; /**< accessors of EXT_mesh_gpu_instancing */
    bool has_matrix, skinned, spawn_point;
    double matrix[16], translation[3], rotation[4], scale[3];
} EnfGltfNode;

typedef struct EnfGltfTextureRef {
    uint32_t texture, uv_set;
    double offset[2], rotation, scale[2]; /**< KHR_texture_transform */
} EnfGltfTextureRef;

typedef struct EnfGltfMaterial {
    const char *name, *alpha_mode;
    EnfGltfTextureRef base, emissive_texture;
    double base_color[4], metallic, roughness, emissive[3], emissive_strength, alpha_cutoff;
    bool double_sided, unlit;
} EnfGltfMaterial;

/** Sampler enumerants; 0 where the file gives no filter. */
typedef struct EnfGltfTexture {
    uint32_t image, mag_filter, min_filter, wrap_s, wrap_t;
} EnfGltfTexture;

typedef struct EnfGltfCamera {
    bool perspective;
    double fov_y, aspect, near_plane, far_plane;
} EnfGltfCamera;

typedef struct EnfGltfLight {
    const char *name, *type;
    double color[3], intensity, range, inner, outer;
} EnfGltfLight;

typedef struct EnfGltfChannel {
    const char *animation, *path, *interpolation;
    uint32_t node, input, output;
} EnfGltfChannel;

typedef struct EnfGltf {
    const char *generator;
    const EnfGltfView *views;
    uint32_t view_count;
    const EnfGltfAccessor *accessors;
    uint32_t accessor_count;
    const EnfGltfPrimitive *primitives;
    uint32_t primitive_count;
    const EnfGltfMesh *meshes;
    uint32_t mesh_count;
    const EnfGltfNode *nodes;
    uint32_t node_count;
    const uint32_t *links; /**< children of nodes, then roots */
    uint32_t link_count;
    uint32_t root_first, root_count; /**< of the scene to import, in links; 0 roots if the file has no scene */
    uint32_t scene_count;
    const EnfGltfMaterial *materials;
    uint32_t material_count;
    const EnfGltfTexture *textures;
    uint32_t texture_count;
    const EnfGltfCamera *cameras;
    uint32_t camera_count;
    const EnfGltfLight *lights;
    uint32_t light_count;
    const EnfGltfChannel *channels;
    uint32_t channel_count;
    void *owner;
} EnfGltf;

/** Reads a text that enf_gltf_check has passed and enf_gltf_fence has rewritten. `view_count` is the number of the file's own
 *  buffer views: a reference to one behind them stands for none. Errors: ENF_ERROR_FORMAT, ENF_ERROR_MEMORY. Throws nothing.
 *  Free with enf_gltf_free. */
EnfResult enf_gltf_parse(EnfGltf *gltf, const char *text, size_t size, uint32_t view_count, EnfError *error);
void enf_gltf_free(EnfGltf *gltf);

#ifdef __cplusplus
}
#endif
#endif

/* EnfSource: a level as its authors gave it, decoded from glTF and nothing more. The importer makes it; cells.c reads it.
 *
 * Plain arrays in one arena-like owner; every index in it has been checked by the importer. World transforms are doubles. */
#ifndef ENFILADE_COMPILE_SOURCE_H
#define ENFILADE_COMPILE_SOURCE_H

#include <enfilade/map.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A triangle list in mesh space: attributes decoded to float, indices expanded (strips and fans too). */
typedef struct EnfSourcePrimitive {
    uint32_t vertex_count, index_count; /**< index_count is a multiple of 3 */
    const float *positions;             /**< 3 a vertex; finite */
    const float *normals;               /**< 3 a vertex, unit; computed flat-smooth by the importer where absent */
    const float *uvs;                   /**< 2 a vertex for the base colour texture's set, or NULL */
    const float *colors;                /**< 4 a vertex, linear, or NULL */
    const uint32_t *indices;
    uint32_t material; /**< in materials, always valid (the importer adds the default material) */
} EnfSourcePrimitive;

typedef struct EnfSourceMesh {
    const char *name;
    uint32_t primitive_first, primitive_count;
} EnfSourceMesh;

typedef struct EnfSourceNode {
    const char *name; /**< never NULL; "node N" where the file gives none */
    uint32_t index;   /**< the node's number in the file (EXT_mesh_gpu_instancing copies share it) */
    uint32_t parent;  /**< in nodes, or ENF_NONE; parents come before children */
    EnfAffine world;  /**< node → world */
    EnfVec3 translation;
    EnfQuat rotation;
    EnfVec3 scale;                /**< decomposed world transform (shear lost) */
    uint32_t mesh, camera, light; /**< or ENF_NONE */
    const char *extras;           /**< the JSON object as text, or "" */
    bool animated;                /**< an animation moves it or one of its ancestors */
} EnfSourceNode;

typedef struct EnfSourceImage {
    const char *name;
    uint32_t width, height;
    const uint8_t *rgba;
} EnfSourceImage;

typedef struct EnfSourcePath {
    const char *animation;
    uint32_t node;
    EnfPathTarget target;
    EnfPathKind kind;
    uint32_t key_count;
    const float *times, *values; /**< values: 3 or 4 a key (× 3 for cubic) */
} EnfSourcePath;

/** As KHR_lights_punctual; range 0 where the file gives none, cone angles in radians. */
typedef struct EnfSourceLight {
    const char *name;
    EnfLightKind kind;
    float color[3], intensity, range, inner, outer;
} EnfSourceLight;

/** In EnfMaterial `name` is unused here; material_names holds it. Texture indices point into `textures`. */
typedef struct EnfSource {
    const EnfSourceNode *nodes;
    uint32_t node_count; /**< only what the default scene reaches, in file order of a walk */
    const EnfSourceMesh *meshes;
    uint32_t mesh_count;
    const EnfSourcePrimitive *primitives;
    uint32_t primitive_count;
    const EnfMaterial *materials;
    const char *const *material_names;
    uint32_t material_count;
    const EnfTexture *textures;
    uint32_t texture_count;
    const EnfSourceImage *images;
    uint32_t image_count;
    const EnfSourceLight *lights;
    uint32_t light_count;
    const EnfMapCamera *cameras;
    uint32_t camera_count;
    const EnfSourcePath *paths;
    uint32_t path_count;
    const char *generator;
    bool has_extras, has_lights; /**< anywhere in the file (PITFALLS 30: which export box to tick) */
    uint64_t hash;               /**< of all bytes read */
    uint64_t triangle_count;     /**< instanced */
    void *owner;                 /**< the importer's memory */
} EnfSource;

/** Warnings of all stages: a code from the catalogue in diagnosis.h, a node name, a sentence. */
struct EnfDiagnosis;

/** Imports a .glb or .gltf. Hostile files are refused with a clear error naming file and JSON path or byte offset; memory is
 *  bounded by limits named in import.h. External images and buffers never outside the level's folder. Free with
 *  enf_source_free. The only user of tinygltf. */
EnfResult enf_source_import(EnfSource *source, const char *path, struct EnfDiagnosis *diagnosis, EnfError *error);
void enf_source_free(EnfSource *source);

/** Translation, rotation and scale of the node's `world`; a mirrored one has a negative x scale, and shear is dropped. */
void enf_source_decompose(EnfSourceNode *node);

#ifdef __cplusplus
}
#endif
#endif

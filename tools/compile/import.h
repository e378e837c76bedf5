/* The importer's inside: what its files share while one level is read. Offered to the outside: source.h. */
#ifndef ENFILADE_COMPILE_IMPORT_H
#define ENFILADE_COMPILE_IMPORT_H

#include "compile/diagnosis.h"
#include "compile/gltf_wrap.h"
#include "compile/json.h"
#include "compile/source.h"

/* Limits against hostile files; JSON has its own (json.h). */
#define ENF_IMPORT_MAX_FILE (UINT64_C(1) << 30)      /* bytes of the level, and of each file beside it */
#define ENF_IMPORT_MAX_MEMORY (UINT64_C(2) << 30)    /* bytes of decoded geometry and scratch */
#define ENF_IMPORT_MAX_PIXELS (UINT64_C(1) << 30)    /* bytes of all decoded images */
#define ENF_IMPORT_MAX_IMAGE 16384                   /* pixels a side */
#define ENF_IMPORT_MAX_ELEMENTS (UINT32_C(1) << 26)  /* vertices or indices of one primitive */
#define ENF_IMPORT_MAX_NODES (UINT32_C(1) << 21)     /* instances counted */
#define ENF_IMPORT_MAX_TRIANGLES (UINT64_C(1) << 26) /* instances counted */

typedef struct EnfImportBytes {
    const uint8_t *data;
    size_t size;
} EnfImportBytes;

/** Elements of an accessor. */
typedef struct EnfImportRange {
    uint32_t first, count;
} EnfImportRange;

/** A buffer or view read at its first use. */
typedef struct EnfImportLazy {
    EnfImportBytes bytes;
    bool ready;
} EnfImportLazy;

typedef struct EnfImportBlock {
    struct EnfImportBlock *next;
    size_t size;
} EnfImportBlock;

/** Blocks freed together. */
typedef struct EnfImportPool {
    EnfImportBlock *blocks;
} EnfImportPool;

typedef struct EnfImport {
    const char *path;
    EnfDiagnosis *diagnosis; /* or NULL */
    EnfError *error;         /* or NULL */
    EnfSource *source;
    EnfImportPool *kept;   /* lives as long as the source */
    EnfImportPool scratch; /* until the import ends */
    uint64_t bytes;        /* of both */
    EnfResult failure;     /* why an allocation failed */
    EnfFile file;
    EnfImportBytes text, binary; /* in file: the JSON; the GLB's BIN chunk */
    EnfJson json;
    EnfGltf gltf;
    EnfImportLazy *buffers, *views;
    uint32_t *buffer_values, *image_values, *node_values; /* their objects in json */
    uint32_t buffer_count, image_count, node_count;
    uint32_t *source_nodes;    /* a file node's place in source->nodes, or ENF_NONE */
    uint32_t *source_textures; /* a file texture's place in source->textures, or ENF_NONE */
    uint32_t *uv_sets;         /* a source material's TEXCOORD set */
    uint32_t *mesh_nodes;      /* the first source node that has the mesh, or ENF_NONE: it is not read */
    uint32_t default_material; /* for primitives without, or ENF_NONE */
} EnfImport;

/* import.c: memory, zeroed; never NULL for a count of 0. NULL when out of memory or beyond the limit: return import->failure. */
void *enf_import_keep(EnfImport *import, size_t count, size_t size);
void *enf_import_scratch(EnfImport *import, size_t count, size_t size);
void enf_import_pool_free(EnfImportPool *pool);
const char *enf_import_text(EnfImport *import, const char *text); /* a kept copy */
/* The JSON values in the root array `key` (scratch); NULL when out of memory. */
uint32_t *enf_import_json_array(EnfImport *import, const char *key, uint32_t *count);

/* import_buffer.c: bytes of buffers and views, read or decoded when first asked for. */
EnfResult enf_import_open(EnfImport *import); /* container: GLB or JSON */
EnfResult enf_import_view(EnfImport *import, uint32_t view, EnfImportBytes *out);
/* import_uri.c: what a uri string stands for; `where` names it in errors. `file` holds bytes of a file beside the level, else the
 * bytes are scratch. ENF_ERROR_IO if that file cannot be read; a uri that leads outside is ENF_ERROR_FORMAT. */
EnfResult enf_import_uri(EnfImport *import, uint32_t value, const char *where, EnfImportBytes *out);
/* `uri` as a relative path in `out`, percent signs decoded; false if it might leave the folder. */
bool enf_import_uri_path(const char *uri, char *out, size_t size);

/* import_accessor.c: `count` elements from `first` on, as floats; the element i begins at out[i * components]; surplus components
 * of the file are dropped, missing ones are left as they are. */
EnfResult enf_import_floats(EnfImport *import, uint32_t accessor, EnfImportRange range, uint32_t components, float *out);
EnfResult enf_import_indices(EnfImport *import, uint32_t accessor, uint32_t *out);

/* image.c: PNG or JPEG to RGBA8. NULL with a reason. Free with enf_image_free. */
uint8_t *enf_image_decode(EnfImportBytes bytes, uint32_t *width, uint32_t *height, const char **reason);
bool enf_image_size(EnfImportBytes bytes, uint32_t *width, uint32_t *height, const char **reason);
void enf_image_free(uint8_t *pixels);
/* image_jpeg.c: may stb_image see this? Anything that is no JPEG may. */
bool enf_jpeg_is_safe(EnfImportBytes bytes);

/* The stages, in this order. */
EnfResult enf_import_nodes(EnfImport *import);     /* import_node.c */
EnfResult enf_import_materials(EnfImport *import); /* import_material.c: with textures, images */
EnfResult enf_import_meshes(EnfImport *import);    /* import_mesh.c */
EnfResult enf_import_lights(EnfImport *import);    /* import_light.c: with cameras */
EnfResult enf_import_paths(EnfImport *import);     /* import_path.c */

#endif

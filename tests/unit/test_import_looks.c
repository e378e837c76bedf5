/* The importer, feature by feature, on documents made by hand: materials, images, uris, lights, cameras, animations, extras,
 * extensions. Geometry is in test_import. */
#define _XOPEN_SOURCE 700 /* symlink, mkfifo */
#include "harness/gltf.h"

#include <math.h>
#include <sys/stat.h>
#include <unistd.h>

#include "compile/import.h"

#define ASSET "\"asset\":{\"version\":\"2.0\"}"
/* Two pixels: opaque red, half transparent green. */
#define PNG "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR42mP4z8DwHwgbABB5A37EGHKQAAAAAElFTkSuQmCC"

static EnfTestImport import_ok(const char *text) {
    EnfTestImport import = enf_test_import_text(text);
    if (import.result != ENF_OK) {
        fail_msg("%s: %s", enf_result_text(import.result), import.error.message);
    }
    return import;
}

static bool is_near(double a, double b) {
    return fabs(a - b) < 1e-6;
}

/* ---- materials -------------------------------------------------------------------------------------------------- */

static void materials_are_read(void **state) {
    (void)state;
    EnfTestImport import = import_ok(
        "{" ASSET ",\"images\":[{\"name\":\"pair\",\"uri\":\"data:image/png;base64," PNG "\"}],"
        "\"samplers\":[{\"magFilter\":9728,\"minFilter\":9984,\"wrapS\":33071,\"wrapT\":33648}],"
        "\"textures\":[{},{\"source\":0,\"sampler\":0},{\"source\":0}],\"materials\":[{\"name\":\"stone\",\"alphaMode\":"
        "\"MASK\","
        "\"alphaCutoff\":0.25,\"doubleSided\":true,\"emissiveFactor\":[1,0.5,0],\"emissiveTexture\":{\"index\":2,\"texCoord\":"
        "1},"
        "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,0.125,0.75],\"metallicFactor\":0.1,\"roughnessFactor\":0.2,"
        "\"baseColorTexture\":{\"index\":1,\"texCoord\":0,\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0.1,0.2],"
        "\"rotation\":1.5707963267948966,\"scale\":[2,3],\"texCoord\":1}}}},\"extensions\":{\"KHR_materials_unlit\":{},"
        "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":4}}},"
        "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}},\"alphaMode\":\"BLEND\"}]}");
    const EnfSource *source = &import.source;
    const EnfMaterial *stone = &source->materials[0];
    assert_int_equal(source->material_count, 2);
    assert_string_equal(source->material_names[0], "stone");
    assert_int_equal(stone->alpha_mode, ENF_ALPHA_MASK);
    assert_int_equal(stone->flags, ENF_MATERIAL_DOUBLE_SIDED | ENF_MATERIAL_UNLIT);
    assert_true(is_near((double)stone->alpha_cutoff, 0.25) && is_near((double)stone->base_color[3], 0.75));
    assert_true(is_near((double)stone->emissive[0], 4.0) && is_near((double)stone->emissive[1], 2.0));
    assert_true(is_near((double)stone->metallic, 0.1) && is_near((double)stone->roughness, 0.2));
    static const double rows[6] = {0, 3, 0.1, -2, 0, 0.2}; /* a quarter turn: u' = 3 v, v' = -2 u */
    for (int i = 0; i < 6; i++) {
        assert_true(is_near((double)stone->uv_transform[i], rows[i]));
    }
    assert_int_equal(source->texture_count, 2);
    assert_int_equal(source->image_count, 1); /* two textures, one image */
    const EnfTexture *texture = &source->textures[stone->texture];
    assert_int_equal(texture->mag_filter, 9728);
    assert_int_equal(texture->min_filter, 9984);
    assert_int_equal(texture->wrap_s, 33071);
    assert_int_equal(texture->wrap_t, 33648);
    assert_int_equal(source->textures[stone->emissive_texture].min_filter, 9987);
    assert_string_equal(source->images[0].name, "pair");
    assert_int_equal(source->images[0].width, 2);
    assert_memory_equal(source->images[0].rgba, ((const uint8_t[]){255, 0, 0, 255, 0, 255, 0, 128}), 8);
    assert_int_equal(source->materials[1].texture, ENF_NONE);
    assert_int_equal(source->materials[1].alpha_mode, ENF_ALPHA_BLEND);
    assert_int_equal(enf_test_found(&import, ENF_DIAGNOSIS_UNSUPPORTED), 1); /* the emissive transform differs */
    enf_test_import_free(&import);
}

/* The set of coordinates is the one that the base colour texture asks for, through its transform if need be. */
static void texture_coordinates_are_chosen(void **state) {
    (void)state;
    float data[3][7] = {{0, 0, 0, .1f, .1f, .5f, .6f}, {1, 0, 0, .2f, .2f, .7f, .8f}, {0, 1, 0, .3f, .3f, .9f, 1}};
    EnfTestText text = {0};
    enf_test_put(&text, "{" ASSET ",");
    enf_test_put_buffer(&text, data, sizeof data);
    enf_test_put(&text, ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":84,\"byteStride\":28}],\"accessors\":["
                        "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
                        "{\"bufferView\":0,\"byteOffset\":12,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"},"
                        "{\"bufferView\":0,\"byteOffset\":20,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"
                        "\"textures\":[{}],\"materials\":[{},{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,"
                        "\"texCoord\":1}}},{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"texCoord\":7}}}],"
                        "\"meshes\":[{\"primitives\":[");
    for (int i = 0; i < 4; i++) {
        char part[160];
        snprintf(part, sizeof part, "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1,\"TEXCOORD_1\":2}%s%.*d}%s",
                 i < 3 ? ",\"material\":" : "", i < 3, i < 3 ? i : 0, i < 3 ? "," : "]}],\"nodes\":[{\"mesh\":0}]}");
        enf_test_put(&text, part);
    }
    EnfTestImport import = import_ok(text.text);
    const EnfSourcePrimitive *p = import.source.primitives;
    assert_true(is_near((double)p[0].uvs[0], 0.1) && is_near((double)p[1].uvs[0], 0.5) && is_near((double)p[1].uvs[5], 1.0));
    assert_null(p[2].uvs);
    assert_int_equal(p[3].material, 3); /* the default material, made because somebody needs it */
    assert_int_equal(import.source.material_count, 4);
    assert_int_equal(import.source.materials[3].alpha_mode, ENF_ALPHA_OPAQUE);
    enf_test_import_free(&import);
    free(text.text);
}

static void material_names_mean_something(void **state) {
    (void)state;
    static const struct {
        const char *name;
        uint32_t flags;
    } cases[] = {
        {"mirror", ENF_MATERIAL_MIRROR},
        {"Mirror_hall", ENF_MATERIAL_MIRROR},
        {"mirrored.001", ENF_MATERIAL_MIRROR},
        {"caulk", ENF_MATERIAL_NODRAW},
        {"Caulk.001", ENF_MATERIAL_NODRAW},
        {"nodraw_2", ENF_MATERIAL_NODRAW},
        {"visportal", ENF_MATERIAL_NODRAW},
        {"AreaPortal", ENF_MATERIAL_NODRAW},
        {"clip", ENF_MATERIAL_NODRAW},
        {"clipboard", 0},
        {"stone", 0},
        {"", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[160];
        snprintf(text, sizeof text, "{" ASSET ",\"materials\":[{\"name\":\"%s\"}]}", cases[i].name);
        EnfTestImport import = import_ok(text);
        assert_int_equal(import.source.materials[0].flags, cases[i].flags);
        enf_test_import_free(&import);
    }
}

static void specular_glossiness_gives_a_base_colour(void **state) {
    (void)state;
    EnfTestImport import = import_ok(
        "{" ASSET ",\"extensionsRequired\":[\"KHR_materials_pbrSpecularGlossiness\"],\"materials\":[{\"extensions\":{"
        "\"KHR_materials_pbrSpecularGlossiness\":{\"diffuseFactor\":[0.5,0,1,1],\"glossinessFactor\":0.25}}}]}");
    const EnfMaterial *material = &import.source.materials[0];
    assert_true(is_near((double)material->base_color[0], 0.5) && is_near((double)material->roughness, 0.75));
    enf_test_import_free(&import);
}

static void unreadable_images_are_white(void **state) {
    (void)state;
    static const char *const images[] = {"{\"uri\":\"absent.png\"}", "{\"uri\":\"data:image/png;base64,AAAA\"}", "{}",
                                         "{\"uri\":\"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgABAAAAAQAACAYAAAA=\"}"};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "{" ASSET ",\"images\":[%s],\"textures\":[{\"source\":0}],"
                 "\"materials\":[{\"emissiveTexture\":{\"index\":0}}]}",
                 images[i]);
        EnfTestImport import = import_ok(text);
        assert_int_equal(enf_test_found(&import, ENF_DIAGNOSIS_IMAGE), 1);
        assert_int_equal(import.source.images[0].width, 1);
        assert_int_equal(import.source.images[0].rgba[0], 255);
        enf_test_import_free(&import);
    }
}

/* stb_image 2.27 writes behind its tables when the counts of a Huffman table add up to more than 256. */
static void overlong_huffman_tables_are_refused(void **state) {
    (void)state;
    uint8_t jpeg[400] = {0xFF, 0xD8, 0xFF, 0xC4, 0x01, 0x13, 0x00}; /* a segment of 275 bytes: 17 + 256 */
    EnfImportBytes bytes = {jpeg, sizeof jpeg};
    memset(jpeg + 7, 16, 16);
    assert_true(enf_jpeg_is_safe(bytes));
    jpeg[7] = 17;
    assert_false(enf_jpeg_is_safe(bytes));
    jpeg[7] = 16;
    bytes.size = 200; /* the tables are cut off */
    assert_false(enf_jpeg_is_safe(bytes));
    uint32_t width, height;
    const char *reason;
    jpeg[7] = 255;
    assert_false(enf_image_size((EnfImportBytes){jpeg, sizeof jpeg}, &width, &height, &reason));
    assert_string_equal(reason, "a JPEG with malformed tables");
}

/* ---- uris ------------------------------------------------------------------------------------------------------- */

static EnfTestImport import_uri(const char *uri) {
    char text[512];
    snprintf(text, sizeof text,
             "{" ASSET ",\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
             "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}]}",
             uri);
    const char *path = enf_test_temp_path("level/level.gltf");
    enf_test_write_file(path, text, strlen(text));
    return enf_test_import_file(path);
}

static void make_folders(void) {
    static const float bytes[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    mkdir(enf_test_temp_path("level"), 0700);
    mkdir(enf_test_temp_path("level/deep"), 0700);
    mkdir(enf_test_temp_path("level2"), 0700);
    enf_test_write_file(enf_test_temp_path("secret.bin"), bytes, sizeof bytes);
    enf_test_write_file(enf_test_temp_path("level2/near.bin"), bytes, sizeof bytes);
    enf_test_write_file(enf_test_temp_path("level/a b.bin"), bytes, sizeof bytes);
    enf_test_write_file(enf_test_temp_path("level/deep/c.bin"), bytes, sizeof bytes);
    (void)!symlink("../secret.bin", enf_test_temp_path("level/link.bin"));
    (void)!symlink("..", enf_test_temp_path("level/up"));
    (void)!symlink("../level2", enf_test_temp_path("level/side"));
    (void)!symlink("deep/c.bin", enf_test_temp_path("level/good.bin"));
    mkfifo(enf_test_temp_path("level/pipe.bin"), 0600);
}

static void files_inside_are_read(void **state) {
    (void)state;
    make_folders();
    static const char *const uris[] = {"a%20b.bin", "a b.bin", "deep/c.bin", "./deep/./c.bin", "good.bin", "deep%2Fc.bin"};
    uint64_t hash = 0;
    for (size_t i = 0; i < sizeof uris / sizeof *uris; i++) {
        EnfTestImport import = import_uri(uris[i]);
        if (import.result != ENF_OK) {
            fail_msg("%s: %s", uris[i], import.error.message);
        }
        assert_int_equal(import.source.triangle_count, 1);
        assert_true(import.source.hash != hash);
        hash = import.source.hash;
        enf_test_import_free(&import);
    }
}

static void files_outside_are_refused(void **state) {
    (void)state;
    make_folders();
    static const char *const uris[] = {
        "../secret.bin",
        "deep/../../secret.bin",
        "%2e%2e/secret.bin",
        "..%2fsecret.bin",
        "%2E%2E%2Fsecret.bin",
        "/etc/passwd",
        "%2Fetc%2Fpasswd",
        "file:///etc/passwd",
        "http://example.org/a.bin",
        "C:\\\\a.bin",
        "..\\\\secret.bin",
        "..%5Csecret.bin",
        "link.bin",
        "up/secret.bin",
        "side/near.bin",
        "../level2/near.bin",
        "deep//c.bin",
        "a%00b.bin",
        "a\\u0000b.bin",
        "a%0ab",
        "%",
        "%2",
        "%zz",
        "pipe.bin",
        "deep",
        "",
        "deep/",
        "?a",
        "file:deep/c.bin",
        "deep/../deep/c.bin",
    };
    for (size_t i = 0; i < sizeof uris / sizeof *uris; i++) {
        EnfTestImport import = import_uri(uris[i]);
        if (import.result == ENF_OK || !strstr(import.error.message, "buffers[0].uri")) {
            fail_msg("%s: %s, %s", uris[i], enf_result_text(import.result), import.error.message);
        }
        assert_int_equal(import.result, ENF_ERROR_FORMAT);
        enf_test_import_free(&import);
    }
    EnfTestImport import = import_uri("absent.bin");
    assert_int_equal(import.result, ENF_ERROR_IO);
    enf_test_import_free(&import);
}

static void images_outside_are_refused(void **state) {
    (void)state;
    EnfTestImport import = enf_test_import_text("{" ASSET ",\"images\":[{\"uri\":\"../a.png\"}],\"textures\":[{\"source\":0}],"
                                                "\"materials\":[{\"emissiveTexture\":{\"index\":0}}]}");
    assert_int_equal(import.result, ENF_ERROR_FORMAT);
    assert_non_null(strstr(import.error.message, "images[0].uri: '../a.png'"));
    enf_test_import_free(&import);
}

/* ---- lights, cameras, extras ------------------------------------------------------------------------------------ */

static void lights_and_cameras_are_read(void **state) {
    (void)state;
    EnfTestImport import = import_ok(
        "{" ASSET ",\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":["
        "{\"type\":\"point\",\"name\":\"lamp\",\"color\":[1,0.5,0.25],\"intensity\":20,\"range\":5},"
        "{\"type\":\"spot\",\"spot\":{\"innerConeAngle\":0.1,\"outerConeAngle\":0.4}},{\"type\":\"directional\"}]}},"
        "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":0.1,\"zfar\":50,\"aspectRatio\":1.5}},"
        "{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":1,\"ymag\":1,\"znear\":0,\"zfar\":1}}],"
        "\"nodes\":[{\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}},{\"camera\":1}]}");
    const EnfSource *source = &import.source;
    assert_true(source->has_lights);
    assert_int_equal(source->light_count, 3);
    assert_string_equal(source->lights[0].name, "lamp");
    assert_int_equal(source->lights[0].kind, ENF_LIGHT_POINT);
    assert_int_equal(source->lights[1].kind, ENF_LIGHT_SPOT);
    assert_int_equal(source->lights[2].kind, ENF_LIGHT_DIRECTIONAL);
    assert_true(is_near((double)source->lights[0].color[1], 0.5) && is_near((double)source->lights[0].range, 5.0));
    assert_true(is_near((double)source->lights[1].outer, 0.4) && is_near((double)source->lights[1].intensity, 1.0));
    assert_int_equal(source->nodes[0].light, 1);
    assert_int_equal(source->nodes[1].camera, 1);
    assert_true(is_near((double)source->cameras[0].fov_y, 1.0) && is_near((double)source->cameras[0].aspect, 1.5));
    assert_int_equal(enf_test_found(&import, ENF_DIAGNOSIS_UNSUPPORTED), 1); /* orthographic */
    enf_test_import_free(&import);
}

static void extras_stay_readable(void **state) {
    (void)state;
    EnfTestImport import = import_ok(
        "{" ASSET ",\"nodes\":[{\"extras\": { \"classname\" : \"light\",\n\"a b\": [ 1.50, \"x \\\" y\" , {} ] } },"
        "{\"extras\":\"text\"},{\"extensions\":{\"OMI_spawn_point\":{}}},"
        "{\"extras\":{\"team\":2},\"extensions\":{\"OMI_spawn_point\":{}}},"
        "{\"extras\":{\"classname\":\"own\"},\"extensions\":{\"OMI_spawn_point\":{}}}]}");
    const EnfSourceNode *nodes = import.source.nodes;
    assert_true(import.source.has_extras);
    assert_string_equal(nodes[0].extras, "{\"classname\":\"light\",\"a b\":[1.50,\"x \\\" y\",{}]}");
    assert_string_equal(nodes[1].extras, "");
    assert_string_equal(nodes[2].extras, "{\"classname\":\"info_player_start\"}");
    assert_string_equal(nodes[3].extras, "{\"classname\":\"info_player_start\",\"team\":2}");
    assert_string_equal(nodes[4].extras, "{\"classname\":\"own\"}");
    enf_test_import_free(&import);
    import = import_ok("{" ASSET ",\"nodes\":[{\"name\":\"extras\"}]}");
    assert_false(import.source.has_extras);
    enf_test_import_free(&import);
}

/* ---- animations ------------------------------------------------------------------------------------------------- */

static void animations_become_paths(void **state) {
    (void)state;
    static const float data[] = {0, 1, 2,                   /* times */
                                 1, 2, 3, 4, 5, 6, 7, 8, 9, /* translations */
                                 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1,
                                 0, 1, 0, 0, 0, /* a cubic rotation, first half */
                                 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 1};
    EnfTestText text = {0};
    enf_test_put(&text, "{" ASSET ",");
    enf_test_put_buffer(&text, data, sizeof data);
    enf_test_put(
        &text,
        ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":12},{\"buffer\":0,\"byteOffset\":12,\"byteLength\":36},"
        "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":144}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"SCALAR\"},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":2,\"componentType\":5126,\"count\":9,\"type\":\"VEC4\"}],"
        "\"nodes\":[{\"name\":\"door\",\"children\":[1]},{\"name\":\"knob\"},{\"name\":\"wall\"}],"
        "\"animations\":[{\"name\":\"open\",\"samplers\":[{\"input\":0,\"output\":1,\"interpolation\":\"STEP\"},"
        "{\"input\":0,\"output\":2,\"interpolation\":\"CUBICSPLINE\"},{\"input\":0,\"output\":1},"
        "{\"input\":1,\"output\":1}],\"channels\":["
        "{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}},"
        "{\"sampler\":1,\"target\":{\"node\":0,\"path\":\"rotation\"}},"
        "{\"sampler\":2,\"target\":{\"node\":0,\"path\":\"scale\"}},"
        "{\"sampler\":2,\"target\":{\"node\":2,\"path\":\"weights\"}},"
        "{\"sampler\":3,\"target\":{\"node\":0,\"path\":\"scale\"}},{\"sampler\":2,\"target\":{\"path\":\"scale\"}}]}]}");
    EnfTestImport import = import_ok(text.text);
    const EnfSource *source = &import.source;
    assert_int_equal(source->path_count, 3);
    assert_int_equal(source->paths[0].kind, ENF_PATH_STEP);
    assert_int_equal(source->paths[1].kind, ENF_PATH_CUBIC);
    assert_int_equal(source->paths[2].kind, ENF_PATH_LINEAR);
    assert_int_equal(source->paths[1].target, ENF_PATH_ROTATION);
    assert_string_equal(source->paths[0].animation, "open");
    assert_int_equal(source->paths[0].key_count, 3);
    assert_memory_equal(source->paths[0].times, data, 12);
    assert_memory_equal(source->paths[0].values, data + 3, 36);
    assert_memory_equal(source->paths[1].values, data + 12, 144);
    assert_true(source->nodes[0].animated && source->nodes[1].animated && !source->nodes[2].animated);
    assert_int_equal(enf_test_found(&import, ENF_DIAGNOSIS_UNSUPPORTED), 2); /* weights; keys that are no scalars */
    enf_test_import_free(&import);
    free(text.text);
}

/* ---- extensions ------------------------------------------------------------------------------------------------- */

static void unknown_extensions_are_named(void **state) {
    (void)state;
    static const char draco[] = "{" ASSET ",\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]}";
    EnfTestImport import = enf_test_import_text(draco);
    assert_int_equal(import.result, ENF_ERROR_UNSUPPORTED);
    assert_string_equal(import.error.message, "extensionsRequired: KHR_draco_mesh_compression is not supported");
    assert_int_equal(import.error.offset, strstr(draco, "\"KHR_draco") - draco);
    enf_test_import_free(&import);
    import = import_ok("{" ASSET
                       ",\"extensionsUsed\":[\"KHR_draco_mesh_compression\",\"KHR_texture_basisu\",\"KHR_lights_punctual\"]}");
    assert_int_equal(enf_test_found(&import, ENF_DIAGNOSIS_UNSUPPORTED), 2);
    assert_non_null(strstr(import.diagnosis.findings[1].message, "KHR_texture_basisu"));
    enf_test_import_free(&import);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(materials_are_read),
    cmocka_unit_test(texture_coordinates_are_chosen),
    cmocka_unit_test(material_names_mean_something),
    cmocka_unit_test(specular_glossiness_gives_a_base_colour),
    cmocka_unit_test(unreadable_images_are_white),
    cmocka_unit_test(overlong_huffman_tables_are_refused),
    cmocka_unit_test(files_inside_are_read),
    cmocka_unit_test(files_outside_are_refused),
    cmocka_unit_test(images_outside_are_refused),
    cmocka_unit_test(lights_and_cameras_are_read),
    cmocka_unit_test(extras_stay_readable),
    cmocka_unit_test(animations_become_paths),
    cmocka_unit_test(unknown_extensions_are_named),
};

ENF_TEST_MAIN(tests)

// EnfGltf from tinygltf: the only C++ file, and the only one that sees tinygltf. Its file access, image decoding and
// assertions are compiled out; whatever it throws ends here.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <fstream> // tinygltf forgets it under NO_FS
#include <tiny_gltf.h>

#include "compile/gltf_wrap.h"

#include <memory>
#include <new>
#include <string_view>

namespace {

struct Owner {
    tinygltf::Model model;
    std::vector<EnfGltfView> views;
    std::vector<EnfGltfAccessor> accessors;
    std::vector<EnfGltfPrimitive> primitives;
    std::vector<EnfGltfMesh> meshes;
    std::vector<EnfGltfNode> nodes;
    std::vector<uint32_t> links;
    std::vector<EnfGltfMaterial> materials;
    std::vector<EnfGltfTexture> textures;
    std::vector<EnfGltfCamera> cameras;
    std::vector<EnfGltfLight> lights;
    std::vector<EnfGltfChannel> channels;
    uint32_t root_first = 0, root_count = 0;
};

uint32_t reference(int index) {
    return index < 0 ? ENF_NONE : static_cast<uint32_t>(index);
}

uint64_t length(int value) {
    return value < 0 ? 0 : static_cast<uint64_t>(value);
}

// ---- extensions --------------------------------------------------------------------------------------------------

const tinygltf::Value *extension(const tinygltf::ExtensionMap &extensions, const char *name) {
    auto found = extensions.find(name);
    return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

const tinygltf::Value *member(const tinygltf::Value &object, const char *key) {
    return object.IsObject() && object.Has(key) ? &object.Get(key) : nullptr;
}

int integer(const tinygltf::Value &object, const char *key, int missing) {
    const tinygltf::Value *value = member(object, key);
    return value && value->IsInt() ? value->Get<int>() : missing;
}

double number(const tinygltf::Value &object, const char *key, double missing) {
    const tinygltf::Value *value = member(object, key);
    return value && value->IsNumber() ? value->GetNumberAsDouble() : missing;
}

const char *text(const tinygltf::Value &object, const char *key, const char *missing) {
    const tinygltf::Value *value = member(object, key);
    return value && value->IsString() ? value->Get<std::string>().c_str() : missing;
}

void numbers(const tinygltf::Value &object, const char *key, double *out, size_t count) {
    const tinygltf::Value *value = member(object, key);
    if (!value || !value->IsArray() || value->ArrayLen() != count) {
        return;
    }
    for (size_t i = 0; i < count; i++) {
        const tinygltf::Value &element = value->Get(i);
        out[i] = element.IsNumber() ? element.GetNumberAsDouble() : out[i];
    }
}

void copy(const std::vector<double> &from, double *out, size_t count) {
    if (from.size() == count) {
        std::copy(from.begin(), from.end(), out);
    }
}

// ---- data --------------------------------------------------------------------------------------------------------

void read_views(Owner &owner, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const tinygltf::BufferView &from = owner.model.bufferViews[i];
        EnfGltfView view = {};
        view.buffer = reference(from.buffer);
        view.stride = static_cast<uint32_t>(from.byteStride);
        view.offset = from.byteOffset;
        view.length = from.byteLength;
        if (const tinygltf::Value *packed = extension(from.extensions, "EXT_meshopt_compression")) {
            view.meshopt.buffer = reference(integer(*packed, "buffer", -1));
            view.meshopt.stride = reference(integer(*packed, "byteStride", 0));
            view.meshopt.offset = length(integer(*packed, "byteOffset", 0));
            view.meshopt.length = length(integer(*packed, "byteLength", 0));
            view.meshopt.count = length(integer(*packed, "count", 0));
            view.meshopt.mode = text(*packed, "mode", "");
            view.meshopt.filter = text(*packed, "filter", "NONE");
        }
        owner.views.push_back(view);
    }
}

void read_accessors(Owner &owner, uint32_t view_count) {
    for (const tinygltf::Accessor &from : owner.model.accessors) {
        EnfGltfAccessor accessor = {};
        accessor.view = reference(from.bufferView);
        if (accessor.view >= view_count) {
            accessor.view = ENF_NONE;
        }
        accessor.component_type = static_cast<uint32_t>(from.componentType);
        accessor.components = static_cast<uint32_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(from.type)));
        accessor.normalized = from.normalized;
        accessor.offset = from.byteOffset;
        accessor.count = from.count;
        if (from.sparse.isSparse) {
            accessor.sparse.count = length(from.sparse.count);
            accessor.sparse.index_view = reference(from.sparse.indices.bufferView);
            accessor.sparse.index_offset = length(from.sparse.indices.byteOffset);
            accessor.sparse.index_type = static_cast<uint32_t>(from.sparse.indices.componentType);
            accessor.sparse.value_view = reference(from.sparse.values.bufferView);
            accessor.sparse.value_offset = length(from.sparse.values.byteOffset);
        }
        owner.accessors.push_back(accessor);
    }
}

uint32_t attribute(const tinygltf::Primitive &primitive, const std::string &name) {
    auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? ENF_NONE : reference(found->second);
}

void read_meshes(Owner &owner) {
    for (const tinygltf::Mesh &from : owner.model.meshes) {
        EnfGltfMesh mesh = {from.name.c_str(), static_cast<uint32_t>(owner.primitives.size()),
                            static_cast<uint32_t>(from.primitives.size())};
        for (const tinygltf::Primitive &part : from.primitives) {
            EnfGltfPrimitive primitive = {};
            primitive.position = attribute(part, "POSITION");
            primitive.normal = attribute(part, "NORMAL");
            primitive.color = attribute(part, "COLOR_0");
            for (uint32_t set = 0; set < ENF_GLTF_UV_SETS; set++) {
                primitive.uv[set] = attribute(part, "TEXCOORD_" + std::to_string(set));
            }
            primitive.indices = reference(part.indices);
            primitive.material = reference(part.material);
            primitive.mode = reference(part.mode);
            primitive.morphed = !part.targets.empty();
            owner.primitives.push_back(primitive);
        }
        owner.meshes.push_back(mesh);
    }
}

// ---- nodes -------------------------------------------------------------------------------------------------------

void read_node_extensions(EnfGltfNode &node, const tinygltf::Node &from) {
    if (const tinygltf::Value *light = extension(from.extensions, "KHR_lights_punctual")) {
        node.light = reference(integer(*light, "light", -1));
    }
    const tinygltf::Value *instancing = extension(from.extensions, "EXT_mesh_gpu_instancing");
    if (const tinygltf::Value *attributes = instancing ? member(*instancing, "attributes") : nullptr) {
        node.instance_translation = reference(integer(*attributes, "TRANSLATION", -1));
        node.instance_rotation = reference(integer(*attributes, "ROTATION", -1));
        node.instance_scale = reference(integer(*attributes, "SCALE", -1));
    }
    node.spawn_point = extension(from.extensions, "OMI_spawn_point") != nullptr;
}

void read_nodes(Owner &owner) {
    for (const tinygltf::Node &from : owner.model.nodes) {
        EnfGltfNode node = {};
        node.name = from.name.c_str();
        node.child_first = static_cast<uint32_t>(owner.links.size());
        node.child_count = static_cast<uint32_t>(from.children.size());
        for (int child : from.children) {
            owner.links.push_back(reference(child));
        }
        node.mesh = reference(from.mesh);
        node.camera = reference(from.camera);
        node.light = node.instance_translation = node.instance_rotation = node.instance_scale = ENF_NONE;
        node.skinned = from.skin >= 0;
        node.has_matrix = from.matrix.size() == 16;
        node.rotation[3] = node.scale[0] = node.scale[1] = node.scale[2] = 1.0;
        copy(from.matrix, node.matrix, 16);
        copy(from.translation, node.translation, 3);
        copy(from.rotation, node.rotation, 4);
        copy(from.scale, node.scale, 3);
        read_node_extensions(node, from);
        owner.nodes.push_back(node);
    }
}

// The default scene, else the first.
void read_scene(Owner &owner) {
    const tinygltf::Model &model = owner.model;
    owner.root_first = static_cast<uint32_t>(owner.links.size());
    if (!model.scenes.empty()) {
        size_t index = model.defaultScene < 0 ? 0 : static_cast<size_t>(model.defaultScene);
        for (int root : model.scenes[index].nodes) {
            owner.links.push_back(reference(root));
        }
    }
    owner.root_count = static_cast<uint32_t>(owner.links.size()) - owner.root_first;
}

// ---- looks -------------------------------------------------------------------------------------------------------

void read_transform(EnfGltfTextureRef &to, const tinygltf::Value &transform) {
    to.uv_set = reference(integer(transform, "texCoord", static_cast<int>(to.uv_set)));
    to.rotation = number(transform, "rotation", 0.0);
    numbers(transform, "offset", to.offset, 2);
    numbers(transform, "scale", to.scale, 2);
}

EnfGltfTextureRef texture_reference(const tinygltf::TextureInfo &from) {
    EnfGltfTextureRef to = {reference(from.index), reference(from.texCoord), {0.0, 0.0}, 0.0, {1.0, 1.0}};
    if (const tinygltf::Value *transform = extension(from.extensions, "KHR_texture_transform")) {
        read_transform(to, *transform);
    }
    return to;
}

// The archived specular-glossiness model, still met in scanned levels: its diffuse part is our base colour.
void read_glossiness(EnfGltfMaterial &material, const tinygltf::Value &from) {
    material.base = {ENF_NONE, 0, {0.0, 0.0}, 0.0, {1.0, 1.0}};
    std::fill(material.base_color, material.base_color + 4, 1.0);
    numbers(from, "diffuseFactor", material.base_color, 4);
    material.metallic = 0.0;
    material.roughness = 1.0 - number(from, "glossinessFactor", 1.0);
    const tinygltf::Value *texture = member(from, "diffuseTexture");
    if (!texture) {
        return;
    }
    material.base.texture = reference(integer(*texture, "index", -1));
    material.base.uv_set = reference(integer(*texture, "texCoord", 0));
    const tinygltf::Value *extensions = member(*texture, "extensions");
    const tinygltf::Value *transform = extensions ? member(*extensions, "KHR_texture_transform") : nullptr;
    if (transform) {
        read_transform(material.base, *transform);
    }
}

void read_materials(Owner &owner) {
    for (const tinygltf::Material &from : owner.model.materials) {
        EnfGltfMaterial material = {};
        material.name = from.name.c_str();
        material.alpha_mode = from.alphaMode.c_str();
        material.alpha_cutoff = from.alphaCutoff;
        material.double_sided = from.doubleSided;
        material.base = texture_reference(from.pbrMetallicRoughness.baseColorTexture);
        material.emissive_texture = texture_reference(from.emissiveTexture);
        std::fill(material.base_color, material.base_color + 4, 1.0);
        copy(from.pbrMetallicRoughness.baseColorFactor, material.base_color, 4);
        copy(from.emissiveFactor, material.emissive, 3);
        material.metallic = from.pbrMetallicRoughness.metallicFactor;
        material.roughness = from.pbrMetallicRoughness.roughnessFactor;
        material.unlit = extension(from.extensions, "KHR_materials_unlit") != nullptr;
        const tinygltf::Value *strength = extension(from.extensions, "KHR_materials_emissive_strength");
        material.emissive_strength = strength ? number(*strength, "emissiveStrength", 1.0) : 1.0;
        if (const tinygltf::Value *gloss = extension(from.extensions, "KHR_materials_pbrSpecularGlossiness")) {
            read_glossiness(material, *gloss);
        }
        owner.materials.push_back(material);
    }
}

void read_textures(Owner &owner) {
    const tinygltf::Model &model = owner.model;
    for (const tinygltf::Texture &from : model.textures) {
        EnfGltfTexture texture = {reference(from.source), 0, 0, TINYGLTF_TEXTURE_WRAP_REPEAT, TINYGLTF_TEXTURE_WRAP_REPEAT};
        if (from.sampler >= 0 && static_cast<size_t>(from.sampler) < model.samplers.size()) {
            const tinygltf::Sampler &sampler = model.samplers[static_cast<size_t>(from.sampler)];
            texture.mag_filter = sampler.magFilter < 0 ? 0 : static_cast<uint32_t>(sampler.magFilter);
            texture.min_filter = sampler.minFilter < 0 ? 0 : static_cast<uint32_t>(sampler.minFilter);
            texture.wrap_s = static_cast<uint32_t>(sampler.wrapS);
            texture.wrap_t = static_cast<uint32_t>(sampler.wrapT);
        }
        owner.textures.push_back(texture);
    }
}

void read_cameras(Owner &owner) {
    for (const tinygltf::Camera &from : owner.model.cameras) {
        const tinygltf::PerspectiveCamera &p = from.perspective;
        EnfGltfCamera camera = {from.type == "perspective", p.yfov, p.aspectRatio, p.znear, p.zfar};
        owner.cameras.push_back(camera);
    }
}

void read_lights(Owner &owner) {
    for (const tinygltf::Light &from : owner.model.lights) {
        EnfGltfLight light = {from.name.c_str(), from.type.c_str(),        {1.0, 1.0, 1.0},         from.intensity,
                              from.range,        from.spot.innerConeAngle, from.spot.outerConeAngle};
        copy(from.color, light.color, 3);
        owner.lights.push_back(light);
    }
}

void read_channels(Owner &owner) {
    for (const tinygltf::Animation &animation : owner.model.animations) {
        for (const tinygltf::AnimationChannel &from : animation.channels) {
            if (from.target_node < 0 || static_cast<size_t>(from.sampler) >= animation.samplers.size()) {
                continue;
            }
            const tinygltf::AnimationSampler &sampler = animation.samplers[static_cast<size_t>(from.sampler)];
            owner.channels.push_back({animation.name.c_str(), from.target_path.c_str(), sampler.interpolation.c_str(),
                                      reference(from.target_node), reference(sampler.input), reference(sampler.output)});
        }
    }
}

// ---- the whole ---------------------------------------------------------------------------------------------------

template <typename T> void give(const std::vector<T> &from, const T *&data, uint32_t &count) {
    data = from.data();
    count = static_cast<uint32_t>(from.size());
}

void publish(EnfGltf *gltf, Owner &owner) {
    gltf->generator = owner.model.asset.generator.c_str();
    give(owner.views, gltf->views, gltf->view_count);
    give(owner.accessors, gltf->accessors, gltf->accessor_count);
    give(owner.primitives, gltf->primitives, gltf->primitive_count);
    give(owner.meshes, gltf->meshes, gltf->mesh_count);
    give(owner.nodes, gltf->nodes, gltf->node_count);
    give(owner.links, gltf->links, gltf->link_count);
    give(owner.materials, gltf->materials, gltf->material_count);
    give(owner.textures, gltf->textures, gltf->texture_count);
    give(owner.cameras, gltf->cameras, gltf->camera_count);
    give(owner.lights, gltf->lights, gltf->light_count);
    give(owner.channels, gltf->channels, gltf->channel_count);
    gltf->root_first = owner.root_first;
    gltf->root_count = owner.root_count;
    gltf->scene_count = static_cast<uint32_t>(owner.model.scenes.size());
    gltf->owner = &owner;
}

EnfResult parse(EnfGltf *gltf, std::string_view document, uint32_t view_count, EnfError *error) {
    auto owner = std::make_unique<Owner>();
    tinygltf::TinyGLTF reader;
    std::string errors, warnings;
    bool read = reader.LoadASCIIFromString(&owner->model, &errors, &warnings, document.data(),
                                           static_cast<unsigned>(document.size()), "", tinygltf::REQUIRE_VERSION);
    if (!read || owner->model.bufferViews.size() < view_count) {
        errors.erase(errors.find_last_not_of(" \n") + 1);
        return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "glTF: %.400s",
                             errors.empty() ? "malformed document" : errors.c_str());
    }
    read_views(*owner, view_count);
    read_accessors(*owner, view_count);
    read_meshes(*owner);
    read_nodes(*owner);
    read_scene(*owner);
    read_materials(*owner);
    read_textures(*owner);
    read_cameras(*owner);
    read_lights(*owner);
    read_channels(*owner);
    publish(gltf, *owner.release());
    return ENF_OK;
}

} // namespace

EnfResult enf_gltf_parse(EnfGltf *gltf, const char *document, size_t size, uint32_t view_count, EnfError *error) {
    *gltf = EnfGltf{};
    try {
        return parse(gltf, std::string_view(document, size), view_count, error);
    } catch (const std::bad_alloc &) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the glTF document");
    } catch (const std::exception &exception) {
        return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "glTF: %.400s", exception.what());
    }
}

void enf_gltf_free(EnfGltf *gltf) {
    delete static_cast<Owner *>(gltf->owner);
    *gltf = EnfGltf{};
}

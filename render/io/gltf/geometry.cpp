#include "io/gltf/geometry.hpp"

#include <cmath>
#include <optional>

#include "base/srgb.hpp"
#include "io/gltf/accessor.hpp"
#include "io/gltf/draco.hpp"
#include "io/import_checks.hpp"
#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

enum class Mode : std::uint64_t { triangles = 4, strip = 5, fan = 6 };

Mode mode_of(const GltfJson& primitive) { return static_cast<Mode>(size_in(primitive, "mode", 4)); }

/// A primitive's arrays; those that it lacks are none.
struct PrimitiveArrays {
    GltfArray positions;
    std::optional<GltfArray> normals, texcoords, colors, indices;
};

class PrimitiveReader {
public:
    PrimitiveReader(const GltfJson& document, const GltfJson& primitive, GltfBuffers& buffers)
        : document_(document),
          primitive_(primitive),
          attributes_(object_in(primitive, "attributes")),
          buffers_(buffers) {}

    PrimitiveArrays read(std::uint32_t texcoord_set) {
        const std::string texcoords = texcoord_name(texcoord_set);
        const bool compressed = !extension_in(primitive_, "KHR_draco_mesh_compression").empty();
        if (compressed)
            draco_ = read_draco_primitive(document_, primitive_, {"POSITION", "NORMAL", texcoords, kColors},
                                          buffers_);
        PrimitiveArrays arrays;
        auto positions = attribute("POSITION");
        if (!positions) throw ImportError("a primitive has no POSITION attribute");
        arrays.positions = *std::move(positions);
        arrays.normals = attribute("NORMAL");
        arrays.texcoords = attribute(texcoords);
        arrays.colors = attribute(kColors);
        if (compressed)
            arrays.indices = std::move(draco_.indices);
        else if (const auto indices = index_in(primitive_, "indices"))
            arrays.indices = read_accessor(document_, buffers_, *indices);
        return arrays;
    }

private:
    static constexpr const char* kColors = "COLOR_0";

    std::string texcoord_name(std::uint32_t set) const {
        const std::string name = "TEXCOORD_" + std::to_string(set);
        return attributes_.contains(name) ? name : "TEXCOORD_0";
    }

    std::optional<GltfArray> attribute(const std::string& name) {
        if (const auto found = draco_.attributes.find(name); found != draco_.attributes.end())
            return std::move(found->second);
        const auto accessor = index_in(attributes_, name.c_str());
        if (!accessor) return std::nullopt;
        return read_accessor(document_, buffers_, *accessor);
    }

    const GltfJson &document_, &primitive_, &attributes_;
    GltfBuffers& buffers_;
    DracoPrimitive draco_;
};

void check_types(const PrimitiveArrays& arrays) {
    if (arrays.positions.components != 3 || (arrays.normals && arrays.normals->components != 3))
        throw ImportError("a primitive's POSITION or NORMAL accessor is not a VEC3");
    if (arrays.indices &&
        (arrays.indices->components != 1 ||
         (arrays.indices->type != GltfComponent::uint8 && arrays.indices->type != GltfComponent::uint16 &&
          arrays.indices->type != GltfComponent::uint32)))
        throw ImportError("a primitive's indices accessor is not a SCALAR of unsigned integers");
    const std::size_t drawn = arrays.indices ? arrays.indices->count : arrays.positions.count;
    if (arrays.positions.count < 3 || drawn < 3)
        throw ImportError("a primitive has too few vertices for its mode");
}

/// What does not fit is not read, as other programs have it.
void leave_out_misfits(PrimitiveArrays& arrays, ConversionWarnings& warnings) {
    if (arrays.texcoords && arrays.texcoords->components != 2) {
        arrays.texcoords.reset();
        warnings.add("texture coordinates that are not a VEC2 are ignored");
    }
    if (arrays.colors && arrays.colors->components != 3 && arrays.colors->components != 4) {
        arrays.colors.reset();
        warnings.add("vertex colours that are not a VEC3 or VEC4 are ignored");
    }
    for (auto* const array : {&arrays.normals, &arrays.texcoords, &arrays.colors})
        if (*array && (*array)->count != arrays.positions.count) {
            array->reset();
            warnings.add(
                "normals, texture coordinates or colours of another count than the positions are ignored");
        }
}

void charge_memory(const PrimitiveArrays& arrays, Mode mode, GltfBuffers& buffers) {
    const std::uint64_t vertex = sizeof(glm::dvec3) + (arrays.normals ? sizeof(glm::vec3) : 0) +
                                 (arrays.texcoords ? sizeof(glm::vec2) : 0) +
                                 (arrays.colors ? sizeof(glm::vec3) : 0);
    const std::uint64_t drawn = arrays.indices ? arrays.indices->count : arrays.positions.count;
    buffers.charge(arrays.positions.count * vertex +
                   (mode == Mode::triangles ? drawn / 3 : drawn) * sizeof(glm::uvec3));
}

bool are_coordinates(const glm::vec3& v) {
    return (int{is_coordinate(v.x)} & int{is_coordinate(v.y)} & int{is_coordinate(v.z)}) != 0;
}

[[noreturn]] void reject_coordinate(const char* what, const std::string& name) {
    throw ImportError(std::string(what) + " of mesh '" + excerpt(name) +
                      "' is not a number from -1e15 to 1e15");
}

void read_positions(const GltfArray& array, const std::string& name, scene::Geometry& geometry) {
    bool all = true;
    geometry.positions.reserve(array.count);
    for_each_vector<3>(array, [&](const glm::vec3& v) {
        all = all && are_coordinates(v);
        geometry.bounds.add(geometry.positions.emplace_back(v));
    });
    if (!all) reject_coordinate("a vertex", name);
}

/// A normal that vanishes is drawn as the face's.
void read_normals(const GltfArray& array, scene::Geometry& geometry, ConversionWarnings& warnings) {
    std::size_t unusable = 0;
    geometry.normals.reserve(array.count);
    for_each_vector<3>(array, [&](const glm::vec3& v) {
        const bool usable = are_coordinates(v);
        geometry.normals.push_back(usable ? v : glm::vec3(0));
        unusable += usable ? 0 : 1;
    });
    warnings.add("a normal that is not a number is replaced by the face's", unusable);
}

/// glTF's v goes downwards. The transform is glTF's too: scaled, turned counter-clockwise as seen, and
/// shifted.
void read_texcoords(const GltfArray& array, const GltfTextureMapping& mapping, const std::string& name,
                    scene::Geometry& geometry) {
    bool all = true;
    const bool identity = mapping.is_identity();
    const double c = std::cos(mapping.rotation), s = std::sin(mapping.rotation);
    geometry.texcoords.reserve(array.count);
    for_each_vector<2>(array, [&](glm::vec2 uv) {
        if (!identity) {
            const glm::dvec2 scaled = mapping.scale * glm::dvec2(uv);
            uv = mapping.offset + glm::dvec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x);
        }
        all = all && is_coordinate(uv.x) && is_coordinate(uv.y);
        geometry.texcoords.emplace_back(uv.x, 1 - uv.y);
    });
    if (!all) reject_coordinate("a texture coordinate", name);
}

/// They are linear.
void read_colors(const GltfArray& array, scene::Geometry& geometry, ConversionWarnings& warnings) {
    geometry.colors.reserve(array.count);
    for_each_vector<3>(array, [&](const glm::vec3& color) {
        geometry.colors.emplace_back(base::srgb_from_linear(glm::dvec3(color)));
    });
    bool opaque = true;
    if (array.components == 4)
        for_each_vector<4>(array, [&](const glm::vec4& color) { opaque = opaque && !(color.a < 1); });
    if (!opaque) warnings.add("the opacity of vertex colours is ignored");
}

/// Puts vertices, as they come, together to triangles.
class TriangleAssembler {
public:
    TriangleAssembler(Mode mode, std::size_t vertices, std::vector<glm::uvec3>& triangles)
        : mode_(mode), triangles_(triangles) {
        triangles.reserve(mode == Mode::triangles ? vertices / 3 : vertices - 2);
    }

    void add(std::uint32_t vertex) {
        if (count_ >= 2 && mode_ == Mode::strip && count_ % 2 == 1)
            triangles_.emplace_back(last_.y, last_.x, vertex);
        else if (mode_ == Mode::triangles ? count_ % 3 == 2 : count_ >= 2)
            triangles_.emplace_back(last_.x, last_.y, vertex);
        if (mode_ == Mode::fan && count_ >= 1)
            last_.y = vertex;
        else if (mode_ == Mode::fan)
            last_.x = vertex;
        else
            last_ = {last_.y, vertex};
        ++count_;
    }

private:
    const Mode mode_;
    std::vector<glm::uvec3>& triangles_;
    glm::uvec2 last_{0};
    std::size_t count_ = 0;
};

void read_triangles(const PrimitiveArrays& arrays, Mode mode, const std::string& name,
                    scene::Geometry& geometry) {
    const auto vertices = static_cast<std::uint32_t>(arrays.positions.count);
    TriangleAssembler triangles(mode, arrays.indices ? arrays.indices->count : vertices, geometry.triangles);
    std::uint32_t last = 0;
    if (arrays.indices)
        for_each_index(*arrays.indices, [&](std::uint32_t index) {
            last = std::max(last, index);
            triangles.add(index);
        });
    else
        for (std::uint32_t i = 0; i < vertices; ++i) triangles.add(i);
    if (last >= vertices) throw ImportError("mesh '" + excerpt(name) + "' has a vertex index out of range");
}

}  // namespace

bool has_triangles(const GltfJson& primitive) {
    const std::uint64_t mode = size_in(primitive, "mode", 4);
    if (mode > 6) throw ImportError("a primitive's mode is invalid");
    return mode >= 4;
}

scene::Geometry read_gltf_geometry(const GltfJson& document, const GltfJson& primitive,
                                   const GltfTextureMapping& mapping, const std::string& name,
                                   GltfBuffers& buffers, ConversionWarnings& warnings) {
    PrimitiveArrays arrays = PrimitiveReader(document, primitive, buffers).read(mapping.set);
    const Mode mode =
        extension_in(primitive, "KHR_draco_mesh_compression").empty() ? mode_of(primitive) : Mode::triangles;
    check_types(arrays);
    leave_out_misfits(arrays, warnings);
    charge_memory(arrays, mode, buffers);
    scene::Geometry geometry;
    read_triangles(arrays, mode, name, geometry);
    read_positions(arrays.positions, name, geometry);
    if (arrays.normals) read_normals(*arrays.normals, geometry, warnings);
    if (arrays.colors) read_colors(*arrays.colors, geometry, warnings);
    if (arrays.texcoords) read_texcoords(*arrays.texcoords, mapping, name, geometry);
    return geometry;
}

}  // namespace vrut::io

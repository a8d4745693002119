#include "io/gltf/draco.hpp"

#include <draco/compression/decode.h>

#include <memory>

#include "io/import_checks.hpp"

namespace vrut::io {

namespace {

[[noreturn]] void fail_damaged() {
    throw ImportError("data compressed by KHR_draco_mesh_compression is damaged");
}

std::unique_ptr<draco::Mesh> decode(std::string_view bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok() || mesh.value() == nullptr) fail_damaged();
    return std::move(mesh).value();
}

template <class Component>
void convert_values(const draco::Mesh& mesh, const draco::PointAttribute& from, GltfArray& to) {
    const auto components = static_cast<std::int8_t>(to.components);
    char* out = to.own.data();
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point, out += to.stride) {
        Component values[16] = {};
        const draco::AttributeValueIndex value = from.mapped_index(point);
        if (value.value() >= from.size() || !from.ConvertValue(value, components, values)) fail_damaged();
        std::memcpy(out, values, to.stride);
    }
}

/// `array` is described by the accessor; of another type than the compressed values it converts them.
void convert_attribute(const draco::Mesh& mesh, const draco::PointAttribute& from, GltfArray& array,
                       GltfBuffers& buffers) {
    array.count = mesh.num_points();
    array.stride = size_of(array.type) * array.components;
    buffers.charge(std::uint64_t{array.count} * array.stride);
    array.own.resize(array.count * array.stride);
    switch (array.type) {
        case GltfComponent::int8:
            return convert_values<std::int8_t>(mesh, from, array);
        case GltfComponent::uint8:
            return convert_values<std::uint8_t>(mesh, from, array);
        case GltfComponent::int16:
            return convert_values<std::int16_t>(mesh, from, array);
        case GltfComponent::uint16:
            return convert_values<std::uint16_t>(mesh, from, array);
        case GltfComponent::uint32:
            return convert_values<std::uint32_t>(mesh, from, array);
        case GltfComponent::float32:
            return convert_values<float>(mesh, from, array);
    }
}

GltfArray indices_of(const draco::Mesh& mesh, GltfBuffers& buffers) {
    GltfArray indices;
    indices.type = GltfComponent::uint32;
    indices.components = 1;
    indices.stride = sizeof(std::uint32_t);
    indices.count = std::size_t{mesh.num_faces()} * 3;
    buffers.charge(indices.count * indices.stride);
    indices.own.resize(indices.count * indices.stride);
    char* out = indices.own.data();
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
        for (const draco::PointIndex& point : mesh.face(face)) {
            const std::uint32_t index = point.value();
            std::memcpy(out, &index, sizeof index);
            out += sizeof index;
        }
    return indices;
}

}  // namespace

DracoPrimitive read_draco_primitive(const GltfJson& document, const GltfJson& primitive,
                                    const std::vector<std::string>& names, GltfBuffers& buffers) {
    const GltfJson& compression = extension_in(primitive, "KHR_draco_mesh_compression");
    const GltfJson& ids = object_in(compression, "attributes");
    const auto mesh = decode(buffers.view(required_index_in(compression, "bufferView")));
    DracoPrimitive result;
    for (const std::string& name : names) {
        const auto id = index_in(ids, name.c_str());
        if (!id) continue;
        const draco::PointAttribute* const from = mesh->GetAttributeByUniqueId(*id);
        if (from == nullptr) fail_damaged();
        GltfArray& array = result.attributes[name];
        array =
            describe_accessor(document, required_index_in(object_in(primitive, "attributes"), name.c_str()));
        convert_attribute(*mesh, *from, array, buffers);
    }
    result.indices = indices_of(*mesh, buffers);
    return result;
}

}  // namespace vrut::io

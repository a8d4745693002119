#include "io/gltf/accessor.hpp"

#include "io/import_checks.hpp"

namespace vrut::io {

namespace {

GltfComponent component_type_in(const GltfJson& json) {
    const std::uint64_t type = size_in(json, "componentType");
    if (type < 5120 || type > 5126 || type == 5124)
        throw ImportError("an accessor's componentType is invalid");
    return static_cast<GltfComponent>(type);
}

bool is_unsigned(GltfComponent type) {
    return type == GltfComponent::uint8 || type == GltfComponent::uint16 || type == GltfComponent::uint32;
}

std::size_t components_of(std::string_view type) {
    constexpr std::pair<std::string_view, std::size_t> kTypes[] = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    for (const auto& [name, count] : kTypes)
        if (type == name) return count;
    throw ImportError("an accessor's type is invalid");
}

std::size_t element_size(const GltfArray& array) { return size_of(array.type) * array.components; }

/// Points the array at its elements in the buffer view that `json` names.
void point_into_view(GltfArray& array, const GltfJson& json, GltfBuffers& buffers) {
    const std::uint32_t view = required_index_in(json, "bufferView");
    const std::string_view bytes = buffers.view(view);
    const std::uint64_t size = element_size(array), stride = buffers.stride(view);
    const std::uint64_t offset = size_in(json, "byteOffset");
    array.stride = static_cast<std::size_t>(stride > 0 ? stride : size);
    const std::uint64_t end = array.count > 0 ? offset + (array.count - 1) * array.stride + size : 0;
    if (array.stride < size || end > bytes.size()) throw ImportError("an accessor exceeds its bufferView");
    if (array.count > 0) array.view = bytes.substr(static_cast<std::size_t>(offset));
}

/// Gives the array its elements as its own, without gaps.
void copy_elements(GltfArray& array, GltfBuffers& buffers) {
    const std::size_t size = element_size(array);
    buffers.charge(std::uint64_t{array.count} * size);
    std::vector<char> own(array.count * size);
    if (!array.view.empty())
        for (std::size_t i = 0; i < array.count; ++i)
            std::memcpy(own.data() + i * size, array.view.data() + i * array.stride, size);
    array.own = std::move(own);
    array.stride = size;
}

void write_sparse_values(GltfArray& array, const GltfJson& sparse, GltfBuffers& buffers) {
    GltfArray indices, values;
    indices.count = values.count = static_cast<std::size_t>(index_in(sparse, "count").value_or(0));
    indices.components = 1;
    indices.type = component_type_in(object_in(sparse, "indices"));
    if (!is_unsigned(indices.type)) throw ImportError("an accessor's componentType is invalid");
    values.components = array.components;
    values.type = array.type;
    point_into_view(indices, object_in(sparse, "indices"), buffers);
    point_into_view(values, object_in(sparse, "values"), buffers);
    const std::size_t size = element_size(array);
    const char* from = values.data();
    for_each_index(indices, [&](std::uint32_t index) {
        if (index >= array.count) throw ImportError("a sparse accessor has an index out of range");
        std::memcpy(array.own.data() + index * size, from, size);
        from += values.stride;
    });
}

}  // namespace

std::size_t size_of(GltfComponent type) {
    switch (type) {
        case GltfComponent::int8:
        case GltfComponent::uint8:
            return 1;
        case GltfComponent::int16:
        case GltfComponent::uint16:
            return 2;
        default:
            return 4;
    }
}

GltfArray describe_accessor(const GltfJson& document, std::uint32_t index) {
    const GltfJson& accessors = array_in(document, "accessors");
    if (index >= accessors.size()) throw ImportError("there is no accessor " + std::to_string(index));
    const GltfJson& json = accessors[index];
    GltfArray array;
    array.type = component_type_in(json);
    array.components = components_of(string_in(json, "type"));
    array.normalized = boolean_in(json, "normalized", false);
    array.count = required_index_in(json, "count");
    return array;
}

GltfArray read_accessor(const GltfJson& document, GltfBuffers& buffers, std::uint32_t index) {
    GltfArray array = describe_accessor(document, index);
    const GltfJson& json = array_in(document, "accessors")[index];
    const bool sparse = json.contains("sparse"), has_view = json.contains("bufferView");
    if (has_view) point_into_view(array, json, buffers);
    if (sparse || !has_view) copy_elements(array, buffers);  // zeros, unless there is a buffer view
    if (sparse) write_sparse_values(array, object_in(json, "sparse"), buffers);
    return array;
}

}  // namespace vrut::io

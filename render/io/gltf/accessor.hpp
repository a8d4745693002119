#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <limits>
#include <string_view>
#include <type_traits>
#include <vector>

#include "io/gltf/buffers.hpp"

namespace vrut::io {

/// The types of an accessor's components, by glTF's numbers.
enum class GltfComponent : std::uint32_t {
    int8 = 5120,
    uint8 = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    float32 = 5126
};

/// The size in bytes.
std::size_t size_of(GltfComponent type);

/// The elements of an accessor, which lie in a buffer or are its own.
struct GltfArray {
    GltfComponent type = GltfComponent::float32;
    std::size_t components = 0;  ///< of an element
    bool normalized = false;
    std::size_t count = 0;
    std::size_t stride = 0;  ///< bytes from one element to the next
    std::vector<char> own;   ///< the bytes, unless they lie in a buffer
    std::string_view view;

    const char* data() const { return own.empty() ? view.data() : own.data(); }
};

/// What an accessor says of its elements: all but their bytes. Throws ImportError.
GltfArray describe_accessor(const GltfJson& document, std::uint32_t index);

/// Returns an accessor's elements, which fit their buffer. Sparse values are in their places. Throws
/// ImportError.
GltfArray read_accessor(const GltfJson& document, GltfBuffers& buffers, std::uint32_t index);

/// Calls `take` with each element of an array of so many components or more, as a vector of floats.
/// Normalized integers are from -1 or 0 to 1.
template <glm::length_t N, class Take>
void for_each_vector(const GltfArray& array, const Take& take);

/// Calls `take` with each element of an array of unsigned integers.
template <class Take>
void for_each_index(const GltfArray& array, const Take& take);

// --- Implementation

template <class Component>
float gltf_number(Component value, bool normalized) {
    if constexpr (!std::is_same_v<Component, float>) {
        if (normalized)
            return std::max(
                static_cast<float>(value) / static_cast<float>(std::numeric_limits<Component>::max()), -1.0F);
    }
    return static_cast<float>(value);
}

template <class Component, class Take>
void for_each_element(const GltfArray& array, std::size_t components, const Take& take) {
    const char* from = array.data();
    Component values[4] = {};
    for (std::size_t i = 0; i < array.count; ++i, from += array.stride) {
        std::memcpy(values, from, components * sizeof(Component));
        take(values);
    }
}

template <glm::length_t N, class Take>
void for_each_vector(const GltfArray& array, const Take& take) {
    const auto take_as = [&]<class Component>(Component) {
        const bool normalized = array.normalized;
        for_each_element<Component>(array, N, [&](const Component* values) {
            glm::vec<N, float> vector(0);
            for (glm::length_t i = 0; i < N; ++i) vector[i] = gltf_number(values[i], normalized);
            take(vector);
        });
    };
    switch (array.type) {
        case GltfComponent::int8:
            return take_as(std::int8_t{});
        case GltfComponent::uint8:
            return take_as(std::uint8_t{});
        case GltfComponent::int16:
            return take_as(std::int16_t{});
        case GltfComponent::uint16:
            return take_as(std::uint16_t{});
        case GltfComponent::uint32:
            return take_as(std::uint32_t{});
        case GltfComponent::float32:
            return take_as(float{});
    }
}

template <class Take>
void for_each_index(const GltfArray& array, const Take& take) {
    const auto take_as = [&]<class Component>(Component) {
        for_each_element<Component>(array, 1, [&](const Component* value) { take(std::uint32_t{*value}); });
    };
    if (array.type == GltfComponent::uint8) return take_as(std::uint8_t{});
    if (array.type == GltfComponent::uint16) return take_as(std::uint16_t{});
    take_as(std::uint32_t{});
}

}  // namespace vrut::io

#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace vrut::io {

/// JSON of a glTF file.
using GltfJson = nlohmann::json;

/// Parses a glTF document. Nothing recurses, and the nesting depth is bounded.
/// Throws ImportError.
GltfJson parse_gltf_json(std::string_view text);

// The members of an object by name. Each throws an ImportError that names the member if it has another type.

/// Returns an empty object if there is none.
const GltfJson& object_in(const GltfJson& parent, const char* name);
/// Returns an empty object if there is none.
const GltfJson& extension_in(const GltfJson& parent, const char* name);
/// Returns an empty array if there is none.
const GltfJson& array_in(const GltfJson& parent, const char* name);
/// Returns an empty string if there is none.
const std::string& string_in(const GltfJson& parent, const char* name);
/// An index of a list.
std::optional<std::uint32_t> index_in(const GltfJson& parent, const char* name);
/// The same of one that must be there.
std::uint32_t required_index_in(const GltfJson& parent, const char* name);
/// A count, length or offset, at most 2^53.
std::uint64_t size_in(const GltfJson& parent, const char* name, std::uint64_t otherwise = 0);
double number_in(const GltfJson& parent, const char* name, double otherwise);
bool boolean_in(const GltfJson& parent, const char* name, bool otherwise);

/// Returns an element of an array as an index of a list.
std::uint32_t index_of(const GltfJson& element, const char* array_name);

/// Throws unless the member is an array of that many numbers. Returns null if there is none.
const GltfJson* numbers_in(const GltfJson& parent, const char* name, std::size_t count);

template <glm::length_t N>
glm::vec<N, double> vector_in(const GltfJson& parent, const char* name, glm::vec<N, double> otherwise) {
    if (const GltfJson* const numbers = numbers_in(parent, name, N))
        for (glm::length_t i = 0; i < N; ++i)
            otherwise[i] = (*numbers)[static_cast<std::size_t>(i)].get<double>();
    return otherwise;
}

}  // namespace vrut::io

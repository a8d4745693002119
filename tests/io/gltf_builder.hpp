#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene_queries.hpp"

namespace vrut {

/// A glTF file in the making: a mesh of one triangle, or of what a test adds.
class GltfBuilder {
public:
    GltfBuilder() {
        document = {
            {"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0}}}}},
            {"nodes", {{{"name", "Part"}, {"mesh", 0}}}},
            {"meshes", {{{"name", "Mesh"}, {"primitives", {{{"attributes", nlohmann::json::object()}}}}}}},
            {"bufferViews", nlohmann::json::array()},
            {"accessors", nlohmann::json::array()}};
    }

    nlohmann::json& primitive() { return document["meshes"][0]["primitives"][0]; }

    /// Appends bytes to the buffer, and returns the number of their view.
    int add_view(const std::string& data) {
        document["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}});
        bytes += data + std::string((4 - data.size() % 4) % 4, '\0');
        return static_cast<int>(document["bufferViews"].size()) - 1;
    }

    /// Returns the number of an accessor; without a view where that is negative.
    int add_accessor(int view, int component, const char* type, std::size_t count, bool normalized = false) {
        nlohmann::json accessor = {{"componentType", component}, {"type", type}, {"count", count}};
        if (view >= 0) accessor["bufferView"] = view;
        if (normalized) accessor["normalized"] = true;
        document["accessors"].push_back(accessor);
        return static_cast<int>(document["accessors"].size()) - 1;
    }

    template <class Number>
    int add_array(const std::vector<Number>& numbers, int component, const char* type, std::size_t width,
                  bool normalized = false) {
        std::string data(numbers.size() * sizeof(Number), '\0');
        std::memcpy(data.data(), numbers.data(), data.size());
        return add_accessor(add_view(data), component, type, numbers.size() / width, normalized);
    }

    /// Adds an attribute of floats to the first primitive.
    void add_floats(const char* name, const std::vector<float>& numbers, std::size_t width) {
        const char* const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
        primitive()["attributes"][name] = add_array(numbers, 5126, types[width - 1], width);
    }

    /// A triangle in the plane z = 0, whose corners are also its texture coordinates.
    void add_triangle() {
        add_floats("POSITION", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
        add_floats("TEXCOORD_0", {0, 0, 1, 0, 0, 1}, 2);
    }

    /// Returns the text of a file with the buffer as `a.bin` beside it, unless the document has others.
    std::string text() const {
        nlohmann::json whole = document;
        if (!whole.contains("buffers")) whole["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "a.bin"}}};
        return whole.dump();
    }

    scene::Scene read() {
        const TemporaryFolder folder;
        folder.write("a.bin", bytes);
        return read_well(folder.write("a.gltf", text()));
    }

    std::string error() {
        const TemporaryFolder folder;
        folder.write("a.bin", bytes);
        const auto scene = io::read_scene(folder.write("a.gltf", text()));
        REQUIRE_FALSE(scene);
        return scene.error();
    }

    nlohmann::json document;
    std::string bytes;
};

/// The first geometry's positions, rounded to thousandths.
inline std::vector<glm::dvec3> rounded_positions(const scene::Scene& scene) {
    std::vector<glm::dvec3> positions;
    for (const glm::dvec3& p : scene.geometries()[0].positions)
        positions.push_back(glm::round(p * 1000.0) / 1000.0);
    return positions;
}

}  // namespace vrut

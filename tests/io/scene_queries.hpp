#pragma once

#include <doctest/doctest.h>

#include "io/read_scene.hpp"
#include "temporary_folder.hpp"

namespace vrut {

inline scene::Scene read_well(const std::filesystem::path& path) {
    auto scene = io::read_scene(path);
    REQUIRE_MESSAGE(scene, scene.error());
    return *std::move(scene);
}

inline const scene::Node& node_of(const scene::Scene& scene, const std::string& name) {
    for (const scene::Node& node : scene.nodes())
        if (node.name == name) return node;
    FAIL("no node " << name);
    return scene.nodes()[0];
}

inline const scene::Node& parent_of(const scene::Scene& scene, const scene::Node& node) {
    return scene.nodes()[static_cast<std::size_t>(node.parent)];
}

inline const scene::Material& material_of(const scene::Scene& scene, const std::string& name) {
    for (const scene::Material& material : scene.materials())
        if (material.name == name) return material;
    FAIL("no material " << name);
    return scene.materials()[0];
}

inline bool is_near(const glm::dvec4& a, const glm::dvec4& b) { return glm::distance(a, b) < 1e-6; }

inline bool has_notice(const scene::Scene& scene, const std::string& part) {
    for (const std::string& notice : scene.notices())
        if (notice.find(part) != std::string::npos) return true;
    return false;
}

/// That a file of that text is refused in one line that names the file and says that.
inline void check_refused_file(const std::string& name, const std::string& text, const std::string& why) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.write(name, text);
    const auto scene = io::read_scene(path);
    REQUIRE_MESSAGE(!scene, "expected: " << why);
    CHECK_MESSAGE(scene.error().starts_with(path.string() + ": "), scene.error());
    CHECK_MESSAGE(scene.error().find(why) != std::string::npos, scene.error());
    CHECK(scene.error().find('\n') == std::string::npos);
}

}  // namespace vrut

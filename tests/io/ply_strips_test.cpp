// PLY files whose triangles are strips.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "scene_queries.hpp"

using namespace vrut;

namespace {

/// Six corners of a ladder, (0, 0) (1, 0) (0, 1) (1, 1) (0, 2) (1, 2), and what follows them in the header
/// and in the file.
std::string ladder(const std::string& elements, const std::string& data) {
    return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n" +
           elements + "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n" + data;
}

const std::string kStrips = "element tristrips 1\nproperty list int int vertex_indices\n";

/// The corners of each triangle, from its lowest on; sorted.
std::vector<std::array<glm::dvec3, 3>> triangles_of(const scene::Scene& scene) {
    std::vector<std::array<glm::dvec3, 3>> triangles;
    const auto before = [](const glm::dvec3& a, const glm::dvec3& b) {
        return std::tie(a.y, a.x) < std::tie(b.y, b.x);
    };
    for (const scene::Geometry& geometry : scene.geometries())
        for (const glm::uvec3& t : geometry.triangles) {
            auto& corners = triangles.emplace_back(
                std::array{geometry.positions[t.x], geometry.positions[t.y], geometry.positions[t.z]});
            std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), before),
                        corners.end());
        }
    std::ranges::sort(triangles, [&](const auto& a, const auto& b) {
        return std::ranges::lexicographical_compare(a, b, before);
    });
    return triangles;
}

using Triangles = std::vector<std::array<glm::dvec3, 3>>;

}  // namespace

TEST_CASE("the triangles of a PLY file's strips are those of faces, the same way round") {
    const TemporaryFolder folder;
    const scene::Scene strips = read_well(folder.write("strips.ply", ladder(kStrips, "6 0 1 2 3 4 5\n")));
    const scene::Scene faces =
        read_well(folder.write("faces.ply", ladder("element face 4\nproperty list uchar int vertex_indices\n",
                                                   "3 0 1 2\n3 2 1 3\n3 2 3 4\n3 4 3 5\n")));
    CHECK(triangles_of(strips).size() == 4);
    CHECK(triangles_of(strips) == triangles_of(faces));
}

TEST_CASE("an index of -1 ends a PLY file's strip, and triangles without area are left out") {
    const TemporaryFolder folder;
    const scene::Scene scene =
        read_well(folder.write("strips.ply", ladder(kStrips, "13 0 1 2 -1 -1 2 3 4 5 -1 4 5 5\n")));
    CHECK(triangles_of(scene) == Triangles{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                                           {{{0, 1, 0}, {1, 1, 0}, {0, 2, 0}}},
                                           {{{1, 1, 0}, {1, 2, 0}, {0, 2, 0}}}});
}

TEST_CASE("PLY strips are read from binary files, too") {
    const TemporaryFolder folder;
    std::string text =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
        "property float y\nproperty float z\n" +
        kStrips + "end_header\n";
    const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const std::int32_t strip[] = {5, 0, 1, 2, 3, -1};
    text.append(reinterpret_cast<const char*>(corners), sizeof corners);
    text.append(reinterpret_cast<const char*>(strip), sizeof strip);
    CHECK(triangles_of(read_well(folder.write("strips.ply", text))).size() == 2);
}

TEST_CASE("a PLY strip with a vertex that is not there is refused") {
    const TemporaryFolder folder;
    for (const char* last : {"6", "-2", "2000000000"}) {
        const auto path = folder.write("strips.ply", ladder(kStrips, "4 0 1 2 " + std::string(last) + "\n"));
        const auto read = io::read_scene(path);
        REQUIRE_FALSE(read);
        CHECK(read.error().find("the mesh has a vertex index out of range") != std::string::npos);
    }
}

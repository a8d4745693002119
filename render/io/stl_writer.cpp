#include "io/stl_writer.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <ostream>

#include "io/visible_shapes.hpp"

namespace vrut::io {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

/// A face's normal, its corners, and two bytes of nothing.
using StlFacet = std::array<char, 50>;

StlFacet facet_of(const std::array<glm::vec3, 3>& corners) {
    const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double length = glm::length(cross);
    const glm::vec3 normal(length > 0 ? cross / length : glm::dvec3(0));
    StlFacet facet{};
    std::memcpy(facet.data(), &normal, 12);
    std::memcpy(facet.data() + 12, corners.data(), 36);
    return facet;
}

/// Under a mirroring matrix corners change their turn, so that the front stays the front.
void write_shape(const ShownShape& shape, std::ostream& out) {
    const bool mirrored = glm::determinant(glm::dmat3(shape.world)) < 0;
    for (const glm::uvec3& triangle : shape.geometry->triangles) {
        std::array<glm::vec3, 3> corners{};
        for (int i = 0; i < 3; ++i)
            corners[static_cast<std::size_t>(mirrored ? 2 - i : i)] =
                glm::vec3(shape.world * glm::dvec4(shape.geometry->positions[triangle[i]], 1));
        const StlFacet facet = facet_of(corners);
        out.write(facet.data(), facet.size());
    }
}

void report_lost_materials(const std::vector<ShownShape>& shapes, ConversionWarnings& warnings) {
    warnings.add("names and materials are lost");
    for (const ShownShape& shape : shapes) {
        if (!shape.geometry->normals.empty())
            warnings.add("vertex normals are lost: STL stores face normals only");
        if (!shape.geometry->colors.empty()) warnings.add("vertex colours are lost");
    }
}

}  // namespace

void write_stl(const scene::Scene& scene, const std::filesystem::path& path, base::OutputFiles& files,
               ConversionWarnings& warnings, const WriteProgress& progress) {
    const auto shapes = shown_shapes(scene, warnings);
    report_lost_nodes(scene, warnings);
    report_lost_tree(scene, warnings);
    report_lost_materials(shapes, warnings);
    std::uint64_t triangles = 0;
    for (const ShownShape& shape : shapes) triangles += shape.geometry->triangles.size();
    if (triangles > UINT32_MAX)
        throw base::WriteError(path.string() + ": an STL file holds at most 2^32 - 1 triangles");
    files.write(path, [&](std::ostream& out) {
        std::array<char, 84> header{};
        std::strncpy(header.data(), "binary STL of vrut-preview", 80);
        const auto count = static_cast<std::uint32_t>(triangles);
        std::memcpy(header.data() + 80, &count, 4);
        out.write(header.data(), header.size());
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            write_shape(shapes[i], out);
            if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(shapes.size()));
        }
    });
}

}  // namespace vrut::io

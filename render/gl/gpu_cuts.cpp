#include "gl/gpu_cuts.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "gl/vertex_arrays.hpp"

namespace vrut::gl {

namespace {

constexpr std::size_t kCutBytes = 4096;  // about what the driver takes for the objects of a cut

std::size_t bytes_of(const plan::CutSurface& surface) {
    const mesh::Cut& cut = surface.cut;
    return kCutBytes + cut.points.size() * sizeof(GpuVertex) + cut.triangles.size() * sizeof(glm::uvec3) +
           (cut.contours.size() + cut.hatching.size()) * sizeof(glm::uvec2);
}

template <class Element>
void write(const GlBuffer& buffer, const std::vector<Element>& elements) {
    const std::span bytes = std::as_bytes(std::span(elements));
    if (bytes.empty()) return;
    glNamedBufferSubData(buffer.get(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

GpuGeometry upload_faces(const plan::CutSurface& surface, const glm::dvec3& origin, bool double_single) {
    const mesh::Cut& cut = surface.cut;
    const glm::vec3 normal(glm::normalize(surface.normal));
    std::vector<GpuVertex> vertices;
    std::vector<glm::vec3> low_positions;
    vertices.reserve(cut.points.size());
    low_positions.reserve(cut.points.size());
    for (const glm::dvec3& point : cut.points) {
        const glm::vec3 position(point - origin);
        vertices.push_back({position, normal});
        low_positions.emplace_back(point - origin - glm::dvec3(position));
    }
    // A buffer holds something, even for no cap.
    const std::size_t room = std::max<std::size_t>(cut.triangles.size(), 1);
    GpuGeometry faces = allocate_alone({vertices.size(), room, false, false, double_single});
    faces.index_count = static_cast<GLsizei>(3 * cut.triangles.size());
    faces.origin = origin;
    write(faces.buffers->vertices, vertices);
    write(faces.buffers->indices, cut.triangles);
    if (double_single) write(faces.buffers->low_positions, low_positions);
    return faces;
}

GpuEdges upload_lines(const mesh::Cut& cut, const GpuGeometry& faces) {
    std::vector<glm::uvec2> lines = cut.contours;
    lines.insert(lines.end(), cut.hatching.begin(), cut.hatching.end());
    GpuEdges edges;
    edges.indices = make_buffer("lines of cuts", lines.data(), lines.size() * sizeof(glm::uvec2));
    edges.vertex_array = vertex_array_of(faces, edges.indices);
    edges.index_count = static_cast<GLsizei>(2 * lines.size());
    return edges;
}

}  // namespace

const GpuCut& GpuCuts::at(const std::shared_ptr<const plan::CutSurface>& surface,
                          const scene::Geometry& geometry, bool double_single) {
    if (const auto found = by_surface_.find(surface.get()); found != by_surface_.end()) {
        entries_.splice(entries_.begin(), entries_, found->second);
        return entries_.front().cut;
    }
    while (!entries_.empty() && bytes_ + bytes_of(*surface) > kMaxBytes) {
        bytes_ -= bytes_of(*entries_.back().surface);
        by_surface_.erase(entries_.back().surface.get());
        entries_.pop_back();
    }
    GpuCut cut;
    cut.faces = upload_faces(*surface, geometry.bounds.center(), double_single);
    cut.lines = upload_lines(surface->cut, cut.faces);
    entries_.push_front({surface, std::move(cut)});
    by_surface_.emplace(surface.get(), entries_.begin());
    bytes_ += bytes_of(*surface);
    return entries_.front().cut;
}

}  // namespace vrut::gl

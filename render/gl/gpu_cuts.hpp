#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <memory>

#include "gl/geometry_buffers.hpp"
#include "gl/handles.hpp"
#include "plan/cut_cache.hpp"
#include "scene/scene.hpp"

namespace vrut::gl {

/// Lines between the vertices of a geometry.
struct GpuEdges {
    GlBuffer indices;
    GlVertexArray vertex_array;  ///< with the geometry's vertices
    GLsizei index_count = 0;
};

/// A cap's triangles, which may be none, and the lines of the cut.
struct GpuCut {
    GpuGeometry faces;
    GpuEdges lines;
};

/// The cuts of a scene's parts on the GPU: uploaded when they are first drawn, since they are small and
/// change from image to image. Beyond kMaxBytes the least recently used are freed.
class GpuCuts {
public:
    static constexpr std::size_t kMaxBytes = std::size_t{32} << 20;

    /// `geometry` is what was cut; `double_single` as Scene::needs_double_single(). The result is valid until
    /// the next call. Throws OutOfMemory.
    const GpuCut& at(const std::shared_ptr<const plan::CutSurface>& surface, const scene::Geometry& geometry,
                     bool double_single);

private:
    struct Entry {
        std::shared_ptr<const plan::CutSurface> surface;
        GpuCut cut;
    };
    std::list<Entry> entries_;  // the latest used first
    std::map<const plan::CutSurface*, std::list<Entry>::iterator> by_surface_;
    std::size_t bytes_ = 0;
};

}  // namespace vrut::gl

#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "gl/handles.hpp"
#include "mesh/triangle_clusters.hpp"
#include "plan/draw_groups.hpp"
#include "scene/scene.hpp"

namespace vrut::gl {

/// The attributes of one instance. Programs with SurfaceVariant::instanced read them instead of uniforms.
struct GpuInstance {
    glm::mat4 view_from_local;
    glm::mat3x4 normal_matrix;
    glm::vec4 base_sides;            ///< w: 1 if two-sided, else 0
    glm::vec4 diffuse_reflectivity;  ///< w: the reflectivity
    glm::vec4 specular_shininess;    ///< w: the shininess
    glm::vec4 clip_plane;            ///< in local space
};
/// The vertex buffer binding to which a draw binds its instances.
inline constexpr GLuint kInstanceBinding = 3;

/// The buffers of one large geometry, or of many small ones. One draw call can draw all that share buffers.
struct GeometryBuffers {
    GlBuffer vertices, indices;
    /// One for each vertex. Whole numbers are subtracted, so that they lie around 0. Null: the geometry has
    /// none. Shared buffers hold unused ones for geometries that have none.
    GlBuffer texcoords;
    GlBuffer colors;  ///< one for each vertex; null: the geometry has none
    /// The rest of each position that float rounds away. Null: positions are single floats.
    GlBuffer low_positions;
    GlVertexArray vertex_array;
    bool shared = false;
};

/// A geometry on the GPU. Positions are floats relative to `origin` (in the geometry's own space): a scene
/// far from the world's origin keeps its precision.
struct GpuGeometry {
    std::shared_ptr<const GeometryBuffers> buffers;
    GLuint first_index = 0;
    /// Of shared buffers: the same triangles with their first two corners swapped. A matrix that mirrors
    /// turns them the right way round, so that one draw call draws mirrored items and others.
    GLuint first_turned_index = 0;
    GLint first_vertex = 0;  ///< added to each index
    GLsizei index_count = 0;
    glm::dvec3 origin{0};
    std::vector<mesh::TriangleCluster> clusters;  ///< mesh::triangle_clusters()

    /// Scene::needs_double_single()
    bool is_double_single() const { return bool(buffers->low_positions); }
};

struct GeometrySizes {
    std::size_t vertices = 0, triangles = 0;
    bool texcoords = false, colors = false, low_positions = false;
};

/// Returns a vertex array of a geometry's vertices with these indices.
GlVertexArray vertex_array_of(const GpuGeometry& geometry, const GlBuffer& indices);

/// Returns a geometry of these sizes with buffers of its own, without contents. Throws OutOfMemory.
GpuGeometry allocate_alone(const GeometrySizes& sizes);

/// Allocates the buffers of a scene's geometries. Small geometries share buffers, which are freed with the
/// last of them.
class GeometryBufferPool {
public:
    explicit GeometryBufferPool(const scene::Scene& scene);
    /// Returns a geometry of these sizes, without contents. Throws OutOfMemory.
    GpuGeometry allocate(const GeometrySizes& sizes);

private:
    void share(const GeometrySizes& sizes, GpuGeometry& geometry);

    std::size_t vertices_at_most_ = 0, triangles_at_most_ = 0;  // of shared buffers
    std::weak_ptr<const GeometryBuffers> shared_;               // that are being filled
    std::size_t shared_vertices_ = 0, shared_triangles_ = 0;    // in use, from the beginning
};

}  // namespace vrut::gl

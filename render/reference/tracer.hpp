#pragma once

#include <optional>
#include <vector>

#include "plan/view.hpp"
#include "reference/shading.hpp"
#include "reference/textures.hpp"
#include "reference/traced_scene.hpp"

namespace vrut::reference {

/// What a view shows in each direction. Safe to ask from several threads.
class Tracer {
public:
    explicit Tracer(const plan::View& view);

    /// `place` is in pixels from the image's top left.
    glm::dvec3 color_at(const glm::dvec2& raster) const;
    scene::Index node_at(const glm::dvec2& raster) const;

    /// A surface that a pixel's colour is made of.
    struct VisibleHit {
        TriangleHit hit;
        RayDifferential ray;     ///< what met it
        bool reflected = false;  ///< it is seen in a mirror
    };
    /// All of them: nearest first, and behind a mirror what is seen in it.
    std::vector<VisibleHit> hits_at(const glm::dvec2& raster) const;
    const std::vector<TracedInstance>& parts() const { return scene_.parts(); }
    RayDifferential generate_ray(const glm::dvec2& raster) const;

private:
    struct ShadedSurface {
        glm::dvec3 color{0};
        double alpha = 1;
    };
    /// A ray, its pixel position in the image, and the mirror that it comes from.
    struct PathRay {
        RayDifferential ray;
        glm::dvec2 raster;
        std::uint32_t mirror = TracedScene::kNoInstance;
    };
    glm::dvec3 radiance(const PathRay& path) const;
    ShadedSurface surface_at(const PathRay& path, const TriangleHit& hit) const;
    glm::dvec3 emitted_light(const TracedInstance& part, const SurfaceInteraction& interaction) const;
    PathRay reflected(const PathRay& path, const TriangleHit& hit) const;
    /// The value of a texture of the part's material; `none` where it shows none.
    glm::dvec4 texel(scene::Index texture, const TracedInstance& part, const SurfaceInteraction& interaction,
                     const glm::dvec4& none) const;
    glm::dvec3 metallic_color(const PathRay& path, const TracedInstance& part,
                              const SurfaceInteraction& interaction, const glm::dvec3& displayed_base) const;
    /// What the ray that is reflected at `normal` meets of the cube map.
    glm::dvec3 environment(const PathRay& path, const SurfaceInteraction& interaction,
                           const glm::dvec3& normal) const;
    glm::dvec3 background(const PathRay& path) const;

    const plan::View& view_;
    TracedScene scene_;
    std::vector<std::optional<MipMap>> textures_;  ///< the scene's; those in use
    std::optional<CubeMap> cube_map_;
    scene::EnvironmentLight environment_light_;
    std::optional<CubeMap> prefiltered_;  ///< where a material needs it
};

}  // namespace vrut::reference

#pragma once

#include <optional>
#include <vector>

#include "plan/view.hpp"
#include "reference/shading.hpp"
#include "reference/surfaces.hpp"
#include "reference/textures.hpp"

namespace vrut::reference {

/// What a view shows in each direction. Safe to ask from several threads.
class Tracer {
public:
    explicit Tracer(const View& view);

    /// `place` is in pixels from the picture's top left.
    glm::dvec3 color_at(const glm::dvec2& place) const;
    Index node_at(const glm::dvec2& place) const;

    /// A surface that a pixel's colour is made of.
    struct Layer {
        Meeting meeting;
        Sight sight;             ///< what met it
        bool reflected = false;  ///< it is seen in a mirror
    };
    /// All of them: nearest first, and behind a mirror what is seen in it.
    std::vector<Layer> layers_at(const glm::dvec2& place) const;
    const std::vector<Part>& parts() const { return surfaces_.parts(); }
    Sight sight_through(const glm::dvec2& place) const;

private:
    struct Surface {
        glm::dvec3 color{0};
        double alpha = 1;
    };
    /// A sight, the place of the picture that it belongs to, and the mirror that it comes from.
    struct Look {
        Sight sight;
        glm::dvec2 place;
        std::uint32_t mirror = Surfaces::kNoPart;
    };
    glm::dvec3 color_of(const Look& look) const;
    Surface surface_at(const Look& look, const Meeting& meeting) const;
    Look reflected(const Look& look, const Meeting& meeting) const;
    glm::dvec3 environment(const Look& look, const Spot& spot) const;
    glm::dvec3 background(const Look& look) const;

    const View& view_;
    Surfaces surfaces_;
    std::vector<std::optional<MipMap>> textures_;  ///< the scene's; those in use
    std::optional<CubeMap> cube_map_;
};

}  // namespace vrut::reference

#pragma once

#include <optional>
#include <string>

#include "plan/view.hpp"
#include "scene/image.hpp"
#include "scene/scene.hpp"

namespace vrut {

/// The colour that the Phong equations give at a point of a surface, in double.
glm::dvec3 phong(const scene::Material& material, const scene::Light& light, const glm::dvec3& eye,
                 const glm::dvec3& point, const glm::dvec3& normal);

/// What a view of a scene shows, computed ray by ray without any of the renderer: opaque surfaces, and flat
/// mirrors, in which mirrors are ordinary surfaces.
class ExpectedImage {
public:
    ExpectedImage(const scene::PlacedScene& placed, const plan::View& view);

    struct Seen {
        /// Which faces or smooth parts, one behind the other, and in a mirror what is seen there; -1 for the
        /// background.
        int surface = -1;
        glm::dvec3 color{0};
    };
    /// At a place in pixels from the picture's top left.
    Seen at(double x, double y) const;
    /// None where the pixel holds an outline or an edge, so that a hair's breadth decides which side is
    /// drawn.
    std::optional<Seen> pixel(int x, int y) const;

private:
    struct ExpectedVertex {
        glm::dvec3 position{0}, normal{0};
    };
    struct ExpectedTriangle {
        ExpectedVertex corners[3];
        scene::Material material;
        int surface = -1;
        bool both_sides = false;
        bool mirrored = false;
        scene::Index mirror = scene::kNone;  ///< the node of a flat mirror
    };
    struct ExpectedHit {
        double distance = 0;
        Seen seen;
        double alpha = 1;
    };
    Seen along(const glm::dvec3& origin, const glm::dvec3& ray, scene::Index from_mirror) const;
    /// In any order, those of the same distance by rising id.
    Seen composited(std::vector<ExpectedHit> hits) const;
    void add(const scene::PlacedScene& placed, std::size_t node, const scene::GeometryData& data);

    plan::View view_;
    std::vector<ExpectedTriangle> triangles_;
    int surfaces_ = 0;
};

struct ImageMismatch {
    int worst = 0;      ///< of 255
    std::string where;  ///< that pixel and both its colours
    int compared = 0;   ///< pixels
    int surfaces = 0;   ///< those of them that show no background
};

/// Compares all pixels but those at outlines and edges.
ImageMismatch difference(const ExpectedImage& expected, const scene::Image& image);

/// The bytes at a pixel, y from the top.
glm::ivec3 pixel_of(const scene::Image& image, int x, int y);
glm::ivec3 bytes_of(const glm::dvec3& color);

}  // namespace vrut

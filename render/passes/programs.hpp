#pragma once

#include <array>

#include "frame_plan.hpp"
#include "gpu_scene.hpp"
#include "program.hpp"
#include "view.hpp"

namespace vrut {

/// Phong light per pixel (Macků 2016, eq. 6.4–6.9 in their robust form), compiled for a kind of light when
/// that first shines.
class SurfacePrograms {
public:
    enum class Shape { faces, edges };
    /// Edges have no side: their normals are turned to the viewer.
    explicit SurfacePrograms(Shape shape) : shape_(shape) {}

    /// Makes the program for the view's light the current one and gives it all that holds for the picture.
    void use(const View& view, const glm::dmat4& clip_from_view);

private:
    Shape shape_;
    std::array<GlProgram, 4> programs_;
};

/// One colour everywhere.
class PlainProgram {
public:
    void use(const glm::dvec3& color, const glm::dmat4& clip_from_view);

private:
    GlProgram program_;
};

/// Where the next draw of the current program lies.
void set_place(const DrawItem& item, const GpuGeometry& geometry);
/// That and how it looks, for SurfacePrograms.
void set_surface(const DrawItem& item, const GpuGeometry& geometry, const Material& material);

}  // namespace vrut

#include "gl/passes/background_pass.hpp"

#include <glm/gtc/type_ptr.hpp>

#include "gl/passes/drawing.hpp"

namespace vrut::gl {

namespace {

enum BackgroundUniform : GLint { pixel_at = 0, shift_at = 1, ray_scale_at = 2, world_from_view_at = 3 };

}  // namespace

void BackgroundPass::draw(const CameraMatrices& camera, const plan::View& view, GpuScene& scene,
                          plan::FrameStats& stats) {
    if (!empty_vertex_array_) {
        empty_vertex_array_ = make_vertex_array();
        clamped_ = make_clamping_sampler();
    }
    const bool has_environment = view.background.shows_cube_map();
    programs_.use(has_environment ? FixedProgram::background_environment : FixedProgram::background_image);
    // The sample's offset in its pixel is part of the projection.
    const glm::dmat4& clip = camera.clip_from_view;
    glUniform2f(pixel_at, 2.0F / static_cast<float>(view.width), 2.0F / static_cast<float>(view.height));
    glUniform2f(shift_at, static_cast<float>(clip[2][0]), static_cast<float>(clip[2][1]));
    if (has_environment) {
        glUniform2f(ray_scale_at, static_cast<float>(1 / clip[0][0]), static_cast<float>(1 / clip[1][1]));
        // Orthogonal, a reflection perhaps.
        const glm::mat3 world_from_view(glm::transpose(glm::dmat3(camera.view_from_world)));
        glUniformMatrix3fv(world_from_view_at, 1, GL_FALSE, glm::value_ptr(world_from_view));
        glBindTextureUnit(0, scene.cube_map(*view.background.cube_map).get());
    } else {
        glBindTextureUnit(0, scene.texture(view.background.texture).get());
        glBindSampler(0, clamped_.get());
    }
    // At infinity: in a mirror only its own pixels have nothing nearer.
    apply(PipelineState());
    glBindVertexArray(empty_vertex_array_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindSampler(0, 0);
    ++stats.draws;
    ++stats.passes;
}

}  // namespace vrut::gl

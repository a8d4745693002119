#include "gl/passes/background_pass.hpp"

#include <glm/gtc/type_ptr.hpp>
#include <string>

#include "gl/passes/drawing.hpp"
#include "gl/passes/texture_filter.hpp"

namespace vrut::gl {

namespace {

enum BackgroundUniform : GLint { pixel_at = 0, shift_at = 1, ray_scale_at = 2, world_from_view_at = 3 };

constexpr std::string_view kVersion = "#version 450 core\n";

// The sample's place goes from -1 to 1 over the view, and so does `shift`.
constexpr std::string_view kSamplePosition = R"(
layout(location = 0) uniform vec2 pixel;
layout(location = 1) uniform vec2 shift;
out vec4 color;

vec2 sample_position() { return gl_FragCoord.xy * pixel - 1 + shift; }
)";

constexpr std::string_view kImageShader = R"(
layout(binding = 0) uniform sampler2D image;

void main() {
    vec2 size = vec2(textureSize(image, 0)) / 2;
    float level = mip_level(vec2(pixel.x * size.x, 0), vec2(0, pixel.y * size.y));
    color = vec4(sample_level(image, sample_position() / 2 + 0.5, level).rgb, 1);
}
)";

// A pixel's ray in view space is (x, y, -1).
constexpr std::string_view kEnvironmentShader = R"(
layout(location = 2) uniform vec2 ray_scale;
layout(location = 3) uniform mat3 world_from_view;
layout(binding = 0) uniform samplerCube environment_map;

void main() {
    vec2 step = pixel * ray_scale;
    vec3 direction = world_from_view * vec3(sample_position() * ray_scale, -1);
    color = vec4(sample_environment(environment_map, direction, world_from_view[0] * step.x, world_from_view[1] * step.y), 1);
}
)";

GlProgram make(std::string_view shader) {
    std::string fragment(kVersion);
    for (const std::string_view part : {kTextureFilter, kSamplePosition, shader}) fragment += part;
    return make_program(kScreenShader, fragment);
}

}  // namespace

void BackgroundPass::draw(const CameraMatrices& camera, const plan::View& view, GpuScene& scene,
                          plan::FrameStats& stats) {
    if (!empty_vertex_array_) {
        empty_vertex_array_ = make_vertex_array();
        clamped_ = make_clamping_sampler();
    }
    const bool has_environment = view.background.cube_map.has_value();
    GlProgram& program = has_environment ? environment_program_ : image_program_;
    if (!program) program = make(has_environment ? kEnvironmentShader : kImageShader);
    glUseProgram(program.get());
    // A sample that lies beside its pixel's centre has moved the projection.
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
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glBindVertexArray(empty_vertex_array_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindSampler(0, 0);
    ++stats.draws;
    ++stats.passes;
}

}  // namespace vrut::gl

#include "gl/passes/background_pass.hpp"

#include <glm/gtc/type_ptr.hpp>
#include <string>

#include "gl/passes/drawing.hpp"
#include "gl/passes/texture_filter.hpp"

namespace vrut {

namespace {

enum Uniform : GLint { pixel_at = 0, shift_at = 1, ray_scale_at = 2, world_from_view_at = 3 };

constexpr std::string_view kVersion = "#version 450 core\n";

// The sample's place goes from -1 to 1 over the view, and so does `shift`.
constexpr std::string_view kPlace = R"(
layout(location = 0) uniform vec2 pixel;
layout(location = 1) uniform vec2 shift;
out vec4 color;

vec2 sample_place() { return gl_FragCoord.xy * pixel - 1 + shift; }
)";

constexpr std::string_view kPictureShader = R"(
layout(binding = 0) uniform sampler2D image;

void main() {
    vec2 size = vec2(textureSize(image, 0)) / 2;
    float level = level_of(vec2(pixel.x * size.x, 0), vec2(0, pixel.y * size.y));
    color = vec4(at_level(image, sample_place() / 2 + 0.5, level).rgb, 1);
}
)";

// A pixel's ray in view space is (x, y, -1).
constexpr std::string_view kPanoramaShader = R"(
layout(location = 2) uniform vec2 ray_scale;
layout(location = 3) uniform mat3 world_from_view;
layout(binding = 0) uniform samplerCube panorama;

void main() {
    vec2 step = pixel * ray_scale;
    vec3 direction = world_from_view * vec3(sample_place() * ray_scale, -1);
    color = vec4(around(panorama, direction, world_from_view[0] * step.x, world_from_view[1] * step.y), 1);
}
)";

GlProgram make(std::string_view shader) {
    std::string fragment(kVersion);
    for (const std::string_view part : {kTextureFilter, kPlace, shader}) fragment += part;
    return make_program(kScreenShader, fragment);
}

}  // namespace

void BackgroundPass::draw(const Sight& sight, const View& view, GpuScene& scene, FrameStats& stats) {
    if (!nothing_) {
        nothing_ = make_vertex_array();
        clamped_ = make_clamping_sampler();
    }
    const bool all_around = view.background.cube_map.has_value();
    GlProgram& program = all_around ? panorama_ : picture_;
    if (!program) program = make(all_around ? kPanoramaShader : kPictureShader);
    glUseProgram(program.get());
    // A sample that lies beside its pixel's centre has moved the projection.
    const glm::dmat4& clip = sight.clip_from_view;
    glUniform2f(pixel_at, 2.0F / static_cast<float>(view.width), 2.0F / static_cast<float>(view.height));
    glUniform2f(shift_at, static_cast<float>(clip[2][0]), static_cast<float>(clip[2][1]));
    if (all_around) {
        glUniform2f(ray_scale_at, static_cast<float>(1 / clip[0][0]), static_cast<float>(1 / clip[1][1]));
        // Orthogonal, a reflection perhaps.
        const glm::mat3 world_from_view(glm::transpose(glm::dmat3(sight.view_from_world)));
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
    glBindVertexArray(nothing_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindSampler(0, 0);
    ++stats.draws;
    ++stats.passes;
}

}  // namespace vrut

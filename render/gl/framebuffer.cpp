#include "gl/framebuffer.hpp"

#include <cassert>
#include <string>
#include <utility>

#include "base/drawing_errors.hpp"

namespace vrut::gl {

namespace {

/// (v + 128) / 257, since 65535 / 255 = 257, in a form that is vectorised.
void round_to_bytes(std::span<const std::uint16_t> rgba16, std::span<std::uint8_t> bytes) {
    for (std::size_t k = 0; k < bytes.size(); ++k)
        bytes[k] = static_cast<std::uint8_t>((rgba16[k] * 255U + 32895U) >> 16);
}

void wait_for(GLsync fence) {
    // One wait may end early; the flush is needed with the first only.
    while (glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, 1'000'000'000) == GL_TIMEOUT_EXPIRED) {
    }
}

}  // namespace

Framebuffer::Framebuffer(int width, int height, bool rgba16)
    : width_(width),
      height_(height),
      rgba16_(rgba16),
      color_(make_texture(rgba16 ? GL_RGBA16 : GL_RGBA8, width, height)),
      depth_(make_texture(GL_DEPTH_COMPONENT32F, width, height)),
      framebuffer_(make_framebuffer()) {
    glNamedFramebufferTexture(framebuffer_.get(), GL_COLOR_ATTACHMENT0, color_.get(), 0);
    glNamedFramebufferTexture(framebuffer_.get(), GL_DEPTH_ATTACHMENT, depth_.get(), 0);
    const GLenum status = glCheckNamedFramebufferStatus(framebuffer_.get(), GL_FRAMEBUFFER);
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    throw_on_gl_error("for a framebuffer of " + size + " pixels");
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw base::GlError(
            "a framebuffer of " + size + " pixels has the status " +
            (status == GL_FRAMEBUFFER_UNSUPPORTED ? "GL_FRAMEBUFFER_UNSUPPORTED" : std::to_string(status)));
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
    glViewport(0, 0, width_, height_);
}

void Framebuffer::read(std::span<std::uint8_t> pixels) {
    assert(pixels.size() == static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 4);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.get());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    if (!rgba16_) {
        glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        return;
    }
    rgba16_pixels_.resize(pixels.size());
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_SHORT, rgba16_pixels_.data());
    round_to_bytes(rgba16_pixels_, pixels);
}

void Framebuffer::read_depth(int first_row, std::span<float> pixels) const {
    const int rows = static_cast<int>(pixels.size()) / width_;
    assert(pixels.size() == static_cast<std::size_t>(width_) * static_cast<std::size_t>(rows));
    assert(first_row >= 0 && first_row + rows <= height_);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.get());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, first_row, width_, rows, GL_DEPTH_COMPONENT, GL_FLOAT, pixels.data());
}

void wait_for_gl() {
    const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    wait_for(fence);
    glDeleteSync(fence);
}

SubmittedWork::~SubmittedWork() { glDeleteSync(last_); }

void SubmittedWork::submit() {
    const GLsync before = std::exchange(last_, glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
    glFlush();
    if (before) wait_for(before);
    glDeleteSync(before);
}

}  // namespace vrut::gl

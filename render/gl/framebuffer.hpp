#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gl/handles.hpp"

namespace vrut::gl {

/// A colour target (RGBA8; `rgba16`: RGBA16, in which many layers can be blended before rounding shows) with
/// depth (32-bit float).
class Framebuffer {
public:
    /// Throws as throw_on_gl_error(), and GlError if the framebuffer is not complete.
    Framebuffer(int width, int height, bool rgba16 = false);

    int width() const { return width_; }
    int height() const { return height_; }
    bool rgba16() const { return rgba16_; }
    /// Its colours and its depth, to be read texel by texel.
    const GlTexture& color() const { return color_; }
    const GlTexture& depth() const { return depth_; }
    /// Makes it what is drawn into, all of it.
    void bind() const;
    /// Copies the colours: 4 bytes a pixel, rows from the bottom up, width · height · 4 bytes in all.
    void read(std::span<std::uint8_t> pixels);
    /// Copies the depth of each pixel, 0 to 1, in the same order, of so many whole rows from a first on.
    void read_depth(int first_row, std::span<float> pixels) const;

private:
    int width_, height_;
    bool rgba16_;
    GlTexture color_, depth_;
    GlFramebuffer framebuffer_;
    std::vector<std::uint16_t> rgba16_pixels_;  // read as they are: the driver takes longer to convert them
};

/// Waits until everything submitted so far is drawn.
void wait_for_gl();

/// Bounds what is submitted and not drawn yet, without a moment in which nothing is submitted.
class SubmittedWork {
public:
    SubmittedWork() = default;
    ~SubmittedWork();
    SubmittedWork(const SubmittedWork&) = delete;
    SubmittedWork& operator=(const SubmittedWork&) = delete;

    /// Submits the commands so far, and waits until those of the call before are drawn.
    void submit();

private:
    GLsync last_ = nullptr;
};

}  // namespace vrut::gl

#pragma once

#include <cstdint>
#include <span>

#include "handles.hpp"

namespace vrut {

/// A colour target (RGBA8) with depth (32-bit float).
class Framebuffer {
public:
    /// Throws std::runtime_error where the driver has no memory for it.
    Framebuffer(int width, int height);

    int width() const { return width_; }
    int height() const { return height_; }
    /// Makes it what is drawn into, all of it.
    void bind() const;
    /// Copies the colours: 4 bytes a pixel, rows from the bottom up, width · height · 4 bytes in all.
    void read(std::span<std::uint8_t> pixels) const;

private:
    int width_, height_;
    GlRenderbuffer color_, depth_;
    GlFramebuffer framebuffer_;
};

/// Waits until everything submitted so far is drawn.
void wait_for_gl();

}  // namespace vrut

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gl/gpu_textures.hpp"
#include "gl/handles.hpp"
#include "plan/draw_budget.hpp"

namespace vrut::gl {

/// Copies from memory to buffers and textures, piece by piece. Source and destination must outlive it.
class Upload {
public:
    /// The first element becomes number `first` of the buffer.
    template <class Element>
    void add(const GlBuffer& buffer, const std::vector<Element>& elements, std::size_t first = 0) {
        const std::span bytes = std::as_bytes(std::span(elements));
        parts_.push_back({buffer.get(), bytes.data(), 1, bytes.size(), first * sizeof(Element), {}});
    }
    void add(const GlTexture& texture, const TextureImage& image);
    /// Copies until `budget` is spent; it may exceed it by 256 KiB or a row of texels. Returns true when all
    /// is copied.
    bool step(plan::DrawBudget& budget);

private:
    struct Part {
        GLuint name = 0;
        const std::byte* data = nullptr;
        std::size_t row_bytes = 1, rows = 0;  ///< of a buffer single bytes
        std::size_t offset = 0;               ///< into a buffer, in bytes
        TextureImage image;                   ///< none for a buffer
    };
    static void copy(const Part& part, std::size_t first, std::size_t count);

    std::vector<Part> parts_;
    std::size_t part_ = 0, row_ = 0;  // the next
};

}  // namespace vrut::gl

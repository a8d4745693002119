#include "gl/upload.hpp"

#include <algorithm>

namespace vrut::gl {

namespace {

constexpr std::size_t kPiece = std::size_t{256} << 10;  // bytes

}  // namespace

void Upload::add(const GlTexture& texture, const TextureImage& image) {
    parts_.push_back({texture.get(), std::as_bytes(std::span(image.image->rgba)).data(),
                      static_cast<std::size_t>(image.image->width) * 4,
                      static_cast<std::size_t>(image.image->height), 0, image});
}

void Upload::copy(const Part& part, std::size_t first, std::size_t count) {
    const std::byte* data = part.data + first * part.row_bytes;
    if (!part.image.image)
        return glNamedBufferSubData(part.name, static_cast<GLintptr>(part.offset + first),
                                    static_cast<GLsizeiptr>(count), data);
    const auto y = static_cast<GLint>(first);
    const auto height = static_cast<GLsizei>(count);
    const GLsizei width = part.image.image->width;
    if (part.image.face)
        glTextureSubImage3D(part.name, part.image.level, 0, y, *part.image.face, width, height, 1, GL_RGBA,
                            GL_UNSIGNED_BYTE, data);
    else
        glTextureSubImage2D(part.name, part.image.level, 0, y, width, height, GL_RGBA, GL_UNSIGNED_BYTE,
                            data);
}

bool Upload::step(plan::DrawBudget& budget) {
    while (part_ < parts_.size() && !budget.is_spent()) {
        const Part& part = parts_[part_];
        const std::size_t count =
            std::min(std::max(kPiece / part.row_bytes, std::size_t{1}), part.rows - row_);
        copy(part, row_, count);
        budget.spend_bytes(count * part.row_bytes);
        row_ += count;
        if (row_ < part.rows) continue;
        ++part_;
        row_ = 0;
    }
    return part_ == parts_.size();
}

}  // namespace vrut::gl

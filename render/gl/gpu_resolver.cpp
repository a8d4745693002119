#include <chrono>
#include <cstdint>
#include <cstring>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include "base/drawing_errors.hpp"
#include "gl/passes/drawing.hpp"
#include "gl/resolver.hpp"

namespace vrut::gl {

namespace {

using Clock = std::chrono::steady_clock;
using Output = plan::RenderJob::Output;
using plan::RenderJob;

enum ResolveUniform : GLint {
    source_max_at = 0,
    samples_at = 1,
    size_at = 2,
    luma_at = 3,
    subsampled_at = 4
};

constexpr GLuint64 kWaitNanoseconds = 1'000'000;  // ns

/// What holds the samples that are resolved.
struct Source {
    const GlTexture& texture;
    int max = 0;  ///< as in sample_bytes.glsl
};

/// A colour texture without depth.
struct ColorTarget {
    ColorTarget(GLenum texture_format, int target_width, int target_height)
        : format(texture_format),
          width(target_width),
          height(target_height),
          texture(make_texture(format, width, height)),
          framebuffer(make_framebuffer()) {
        glNamedFramebufferTexture(framebuffer.get(), GL_COLOR_ATTACHMENT0, texture.get(), 0);
        const GLenum status = glCheckNamedFramebufferStatus(framebuffer.get(), GL_FRAMEBUFFER);
        throw_on_gl_error("for a framebuffer of samples");
        if (status != GL_FRAMEBUFFER_COMPLETE)
            throw base::GlError("a framebuffer of samples has the status " + std::to_string(status));
    }
    bool fits(GLenum other_format, int other_width, int other_height) const {
        return format == other_format && width == other_width && height == other_height;
    }

    GLenum format;
    int width, height;
    GlTexture texture;
    GlFramebuffer framebuffer;
};

/// A buffer that stays mapped, into which pixels are copied while the CPU does other things.
class PixelBuffer {
public:
    explicit PixelBuffer(std::size_t bytes) : bytes_(bytes), buffer_(make_readback_buffer("pixels", bytes)) {
        constexpr GLbitfield kAccess = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
        data_ = static_cast<const std::uint8_t*>(
            glMapNamedBufferRange(buffer_.get(), 0, static_cast<GLsizeiptr>(bytes), kAccess));
        throw_on_gl_error("to map a buffer of pixels");
        if (!data_) throw base::OutOfMemory("the graphics driver has no memory to map a buffer of pixels");
    }
    ~PixelBuffer() { glDeleteSync(fence_); }
    PixelBuffer(const PixelBuffer&) = delete;
    PixelBuffer& operator=(const PixelBuffer&) = delete;

    std::size_t size() const { return bytes_; }

    /// From a framebuffer that is bound for reading.
    void begin_read(int width, int height, GLenum format) {
        glDeleteSync(fence_);
        fence_ = nullptr;
        glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.get());
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glReadPixels(0, 0, width, height, format, GL_UNSIGNED_BYTE, nullptr);
        glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
        fence_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    }
    /// Waits for a millisecond at most.
    bool is_read() const {
        return glClientWaitSync(fence_, GL_SYNC_FLUSH_COMMANDS_BIT, kWaitNanoseconds) != GL_TIMEOUT_EXPIRED;
    }
    /// Once they are read.
    void copy_to(std::vector<std::uint8_t>& pixels) const {
        std::memcpy(pixels.data(), data_, pixels.size());
    }

private:
    std::size_t bytes_;
    GlBuffer buffer_;
    const std::uint8_t* data_ = nullptr;
    GLsync fence_ = nullptr;
};

class GpuResolver final : public Resolver {
public:
    explicit GpuResolver(Programs& programs) : programs_(programs) {}

    void read(RenderJob& job, Framebuffer& target) override {
        const Source sample{target.color(), target.rgba16() ? 65535 : 255};
        if (job.keep == RenderJob::Keep::samples)
            accumulate(job, sample);
        else
            begin_read(job, sample, 1);
    }

    void add(RenderJob& job) override { ++job.samples; }

    bool resolve(RenderJob& job) override {
        Read* read = find(reads_, job);
        if (!read) read = &begin_read(job, {find(sums_, job)->target.texture, 0}, job.samples);
        if (!read->buffer->is_read()) return false;
        if (job.output == Output::rgba) {
            read->buffer->copy_to(job.image.rgba);
        } else {
            job.planes.resize(job.view.width, job.view.height, job.output == Output::ycbcr_420);
            read->buffer->copy_to(job.planes.bytes);
        }
        job.stats.readback_ms +=
            std::chrono::duration<double, std::milli>(Clock::now() - read->start).count();
        read->job.reset();
        return true;
    }

    bool holds(const RenderJob& job) const override {
        if (job.samples == 0) return true;
        if (job.keep == RenderJob::Keep::image) return find(reads_, job) != nullptr;
        const Sums* sums = find(sums_, job);
        return sums && sums->samples == job.samples;
    }

    void release() override {
        std::erase_if(sums_, [](const Sums& sums) { return sums.job.expired(); });
        std::erase_if(reads_, [](const Read& read) { return read.job.expired(); });
        output_.reset();
    }

private:
    /// Whose job is expired may be used for another.
    struct Sums {
        std::weak_ptr<const plan::FramePlanner> job;
        ColorTarget target;
        int samples = 0;
    };
    struct Read {
        std::weak_ptr<const plan::FramePlanner> job;
        std::unique_ptr<PixelBuffer> buffer;
        Clock::time_point start;
    };

    template <class Entries>
    static auto find(Entries& entries, const RenderJob& job) -> decltype(&entries.front()) {
        for (auto& entry : entries)
            if (entry.job.lock() == job.planner) return &entry;
        return nullptr;
    }

    void draw(const ColorTarget& target, FixedProgram program, const Source& source, int samples,
              PipelineState::Blend blend) {
        if (!empty_vertex_array_) empty_vertex_array_ = make_vertex_array();
        PipelineState state;
        state.depth_test = false;
        state.blend = blend;
        apply(state);
        set_scissor({});
        glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
        glViewport(0, 0, target.width, target.height);
        programs_.use(program);
        glUniform1i(source_max_at, source.max);
        glUniform1i(samples_at, samples);
        glBindTextureUnit(0, source.texture.get());
        glBindVertexArray(empty_vertex_array_.get());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glBindTextureUnit(0, 0);
    }

    void accumulate(const RenderJob& job, const Source& sample) {
        Sums& sums = job.samples == 0 ? begin_sums(job) : *find(sums_, job);
        draw(sums.target, FixedProgram::accumulate, sample, 1,
             sums.samples == 0 ? PipelineState::Blend::none : PipelineState::Blend::add);
        ++sums.samples;
    }

    Sums& begin_sums(const RenderJob& job) {
        Sums* sums = find(sums_, job);
        for (Sums& other : sums_)
            if (!sums && other.job.expired() &&
                other.target.fits(GL_RGBA32F, job.view.width, job.view.height))
                sums = &other;
        if (!sums) {
            std::erase_if(sums_, [](const Sums& other) { return other.job.expired(); });
            sums = &sums_.emplace_back(Sums{{}, {GL_RGBA32F, job.view.width, job.view.height}, 0});
        }
        sums->job = job.planner;
        sums->samples = 0;
        return *sums;
    }

    const ColorTarget& output(GLenum format, int width, int height) {
        if (!output_ || !output_->fits(format, width, height)) {
            output_.reset();
            output_.emplace(format, width, height);
        }
        return *output_;
    }

    Read& begin_read(RenderJob& job, const Source& source, int samples) {
        const Clock::time_point start = Clock::now();
        const int width = job.view.width, height = job.view.height;
        if (job.output == Output::rgba) {
            const ColorTarget& target = output(GL_RGBA8, width, height);
            draw(target, FixedProgram::resolve_rgba, source, samples, PipelineState::Blend::none);
            return begin_read(job, target, 4, start);
        }
        scene::PlanarImage planes;
        planes.width = width;
        planes.height = height;
        planes.subsampled = job.output == Output::ycbcr_420;
        const ColorTarget& target = output(GL_R8, planes.stride(), planes.rows());
        programs_.use(FixedProgram::resolve_planes);
        glUniform2i(size_at, width, height);
        glUniform2i(luma_at, planes.stride(), planes.luma_rows());
        glUniform1i(subsampled_at, planes.subsampled);
        draw(target, FixedProgram::resolve_planes, source, samples, PipelineState::Blend::none);
        return begin_read(job, target, 1, start);
    }

    Read& begin_read(RenderJob& job, const ColorTarget& target, std::size_t pixel_bytes,
                     Clock::time_point start) {
        const std::size_t bytes =
            static_cast<std::size_t>(target.width) * static_cast<std::size_t>(target.height) * pixel_bytes;
        Read* read = nullptr;
        for (Read& other : reads_)
            if (other.job.expired() && other.buffer->size() >= bytes) read = &other;
        if (!read) {
            std::erase_if(reads_, [](const Read& other) { return other.job.expired(); });
            read = &reads_.emplace_back(Read{{}, std::make_unique<PixelBuffer>(bytes), {}});
        }
        glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer.get());
        read->buffer->begin_read(target.width, target.height, pixel_bytes == 4 ? GL_RGBA : GL_RED);
        read->job = job.planner;
        read->start = start;
        ++job.stats.readbacks;
        return *read;
    }

    Programs& programs_;
    GlVertexArray empty_vertex_array_;  // the corners of a full-screen triangle need no attributes
    std::list<Sums> sums_;
    std::list<Read> reads_;
    std::optional<ColorTarget> output_;  // of the last image; copied before the next is drawn
};

}  // namespace

std::unique_ptr<Resolver> make_gpu_resolver(Programs& programs) {
    return std::make_unique<GpuResolver>(programs);
}

}  // namespace vrut::gl

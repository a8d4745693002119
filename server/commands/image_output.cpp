#include "commands/image_output.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "base/files.hpp"
#include "commands/film.hpp"
#include "observe/progress.hpp"

namespace vrut::server::commands {

namespace fs = std::filesystem;

bool is_film(const fs::path& output) { return output.extension() == ".mp4"; }

void require_film(const fs::path& output, int width, int height) {
    if (width % 2 != 0 || height % 2 != 0)
        throw std::invalid_argument("--size: width and height of a film are even; the next size for " +
                                    std::to_string(width) + "x" + std::to_string(height) + " is " +
                                    std::to_string(width + width % 2) + "x" +
                                    std::to_string(height + height % 2));
    require_film_encoder(output);
}

fs::path numbered(const fs::path& output, std::size_t i) {
    const std::string number = std::to_string(i + 1);
    fs::path path = output;
    path.replace_filename(output.stem().string() + "-" +
                          std::string(number.size() < 4 ? 4 - number.size() : 0, '0') + number +
                          output.extension().string());
    return path;
}

ImageOutput::ImageOutput(Options options) : options_(std::move(options)) {
    if (options_.shows_progress) progress_ = observe::loading_bar(options_.path.filename().string());
    const bool has_film = is_film(options_.path);
    if (has_film || options_.are_numbered) stop_.emplace();  // before there is a file to remove
    if (has_film) film_.emplace(options_.path, options_.width, options_.height, options_.images_per_second);
}

void ImageOutput::add(scene::Image& image) {
    wait();
    std::swap(image_, image);
    repeat();
}

void ImageOutput::repeat() {
    wait();
    if (stop_ && stop_->came())
        throw std::runtime_error(options_.path.string() + ": a signal stopped the film at image " +
                                 std::to_string(written_) + " of " + std::to_string(options_.images));
    writing_ = std::async(std::launch::async, [this] { write(); });
}

void ImageOutput::finish() {
    wait();
    if (film_) film_->finish();
}

void ImageOutput::write() {
    if (film_)
        film_->add(image_);
    else
        base::write_file(options_.are_numbered ? numbered(options_.path, written_) : options_.path,
                         encoded(image_, format_of(options_.path), options_.jpeg_quality));
}

void ImageOutput::wait() {
    if (!writing_.valid()) return;
    writing_.get();
    ++written_;
    if (progress_) progress_(static_cast<double>(written_) / static_cast<double>(options_.images));
}

}  // namespace vrut::server::commands

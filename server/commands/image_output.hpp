#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <future>
#include <optional>

#include "commands/film_writer.hpp"
#include "commands/stop_signals.hpp"
#include "scene/image.hpp"

namespace vrut::server::commands {

/// Returns true if the name ends in .mp4.
bool is_film(const std::filesystem::path& output);

/// Throws where no film of this size can be written: std::invalid_argument where the size is odd, else
/// std::runtime_error with the remedy.
void require_film(const std::filesystem::path& output, int width, int height);

/// The path of image `i`, from 0: with its number, from 0001, behind the stem.
std::filesystem::path numbered(const std::filesystem::path& output, std::size_t i);

/// Where the images of a command go, in their order: into one film, or into files. Errors are
/// std::runtime_error with a sentence.
class ImageOutput {
public:
    struct Options {
        std::filesystem::path path;
        int width = 0, height = 0;   ///< of a film
        int images_per_second = 30;  ///< of a film
        int jpeg_quality = 90;
        std::size_t images = 1;
        bool are_numbered = false;   ///< images of a film in files of their own
        bool shows_progress = true;  ///< on a terminal
    };

    /// A film's file is begun.
    explicit ImageOutput(Options options);

    /// Writes the image while the caller goes on, and gives another one in its place to draw into. Throws
    /// what the image before it met, or where a signal has stopped a film.
    void add(scene::Image& image);
    /// The last image once more.
    void repeat();
    /// Waits for the last image, and completes the film.
    void finish();

private:
    void write();
    void wait();

    Options options_;
    std::function<void(double)> progress_;
    std::optional<StopSignals> stop_;  // of films
    std::optional<FilmWriter> film_;
    std::size_t written_ = 0;
    scene::Image image_;  // that is being written
    std::future<void> writing_;
};

}  // namespace vrut::server::commands

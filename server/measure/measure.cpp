#include "measure/measure.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "compare/difference.hpp"
#include "compare/flip.hpp"
#include "io/image/image_file.hpp"
#include "navigation/camera_moves.hpp"
#include "scene/camera.hpp"

namespace vrut::server::measure {

namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;

constexpr int kMostTries = 3;  // until everything that a picture needs is on the GPU

double percentile(const std::vector<double>& sorted, double part) {
    const double at = part * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
}

bool drawn_alike(Setting a, const Setting& b) {
    a.jpeg_quality = b.jpeg_quality;
    a.subsampled = b.subsampled;
    return a == b;
}

/// Settings that share a drawing, by their indices.
std::vector<std::vector<std::size_t>> drawings_of(std::span<const Setting> settings) {
    std::vector<std::vector<std::size_t>> drawings;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const auto same = std::find_if(drawings.begin(), drawings.end(), [&](const auto& drawing) {
            return drawn_alike(settings[drawing.front()], settings[i]);
        });
        if (same == drawings.end())
            drawings.push_back({i});
        else
            same->push_back(i);
    }
    return drawings;
}

/// Between which two pixels of `count` a point of a longer or shorter row lies, and how far from the first.
struct Place {
    std::size_t first = 0, second = 0;
    double part = 0;
};

std::vector<Place> places(int count, int wanted) {
    std::vector<Place> row(static_cast<std::size_t>(wanted));
    for (std::size_t i = 0; i < row.size(); ++i) {
        const double at = std::clamp((static_cast<double>(i) + 0.5) * count / wanted - 0.5, 0.0, count - 1.0);
        row[i].first = static_cast<std::size_t>(at);
        row[i].second = std::min(row[i].first + 1, static_cast<std::size_t>(count) - 1);
        row[i].part = at - static_cast<double>(row[i].first);
    }
    return row;
}

double mean_of(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

Spread spread_of(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    return {sum / static_cast<double>(values.size()), percentile(values, 0.5), percentile(values, 0.05),
            percentile(values, 0.95)};
}

plan::View on_orbit(const plan::View& home, int step, int steps) {
    plan::View view = home;
    view.camera = navigation::rotated(home.camera, 360.0 * step / steps, 0, true);
    return view;
}

std::vector<plan::View> judged_views(const plan::View& home, int count) {
    std::vector<plan::View> views;
    views.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) views.push_back(on_orbit(home, i, count));
    return views;
}

scene::Image resized(const scene::Image& image, int width, int height) {
    if (image.width == width && image.height == height) return image;
    const std::vector<Place> columns = places(image.width, width), rows = places(image.height, height);
    scene::Image result;
    result.resize(width, height);
    std::uint8_t* next = result.rgba.data();
    for (const Place& row : rows)
        for (const Place& column : columns) {
            const auto at = [&](std::size_t y, std::size_t x, std::size_t k) {
                return static_cast<double>(
                    image.rgba[4 * (y * static_cast<std::size_t>(image.width) + x) + k]);
            };
            for (std::size_t k = 0; k < 4; ++k)
                *next++ = static_cast<std::uint8_t>(std::lround(std::lerp(
                    std::lerp(at(row.first, column.first, k), at(row.first, column.second, k), column.part),
                    std::lerp(at(row.second, column.first, k), at(row.second, column.second, k), column.part),
                    row.part)));
        }
    return result;
}

double Studio::draw(const plan::View& view) {
    drawn_ = view;
    for (int i = 0; i < kMostTries; ++i) {
        stats_ = {};
        renderer_.render(view, image_, stats_);
        if (stats_.uploads == 0) break;
    }
    return stats_.render_ms + stats_.readback_ms;
}

void Studio::make_buffers(const plan::View& view) {
    if (!drawn_ || drawn_->width != view.width || drawn_->height != view.height) draw(view);
}

std::vector<Cost> Studio::costs(const plan::View& home, std::span<const Setting> settings, int frames,
                                const PartDone& done) {
    const auto drawings = drawings_of(settings);
    std::vector<Cost> costs(settings.size());
    std::vector<std::vector<double>> ms(settings.size()), bytes(settings.size());
    for (int frame = 0; frame < frames; ++frame) {
        const plan::View view = on_orbit(home, frame, frames);
        for (std::size_t k = 0; k < drawings.size(); ++k) {
            const plan::View wanted = view_with(view, settings[drawings[k].front()]);
            make_buffers(wanted);
            const double drawn = draw(wanted);
            for (const std::size_t i : drawings[k]) {
                costs[i].triangles += static_cast<double>(stats_.triangles) / frames;
                ms[i].push_back(drawn);
                if (settings[i].jpeg_quality == 0) continue;
                const auto start = std::chrono::steady_clock::now();
                const auto file = jpeg_.encode(image_, settings[i].jpeg_quality, settings[i].subsampled);
                ms[i].back() += Milliseconds(std::chrono::steady_clock::now() - start).count();
                bytes[i].push_back(static_cast<double>(file.size()));
            }
            if (done)
                done((static_cast<double>(k + 1) / static_cast<double>(drawings.size()) + frame) / frames);
        }
    }
    for (std::size_t i = 0; i < settings.size(); ++i) {
        costs[i].ms = spread_of(ms[i]);
        costs[i].bytes = spread_of(bytes[i]);
    }
    return costs;
}

scene::Image Studio::picture(const plan::View& view, const Setting& setting) {
    if (const plan::View wanted = view_with(view, setting); wanted != drawn_) draw(wanted);
    if (setting.jpeg_quality == 0) return image_;
    const auto file = jpeg_.encode(image_, setting.jpeg_quality, setting.subsampled);
    auto decoded = io::decode_image({reinterpret_cast<const char*>(file.data()), file.size()});
    if (!decoded) throw std::runtime_error("an image that was encoded cannot be read: " + decoded.error());
    return *std::move(decoded);
}

scene::Image Studio::exact_picture(const plan::View& view, int samples) {
    Setting exact;
    exact.samples = samples;
    exact.jpeg_quality = 0;
    return picture(view, exact);
}

std::vector<Error> Studio::errors(std::span<const plan::View> views, std::span<const Setting> settings,
                                  std::span<const scene::Image> judges, const PartDone& done) {
    std::vector<Error> errors(settings.size());
    std::vector<std::vector<double>> means(settings.size());
    std::size_t count = 0;
    for (std::size_t v = 0; v < views.size(); ++v)
        for (const auto& drawing : drawings_of(settings))
            for (const std::size_t i : drawing) {
                const scene::Image shown =
                    resized(picture(views[v], settings[i]), judges[v].width, judges[v].height);
                means[i].push_back(mean_of(compare::flip(shown, judges[v])));
                errors[i].maximum =
                    std::max(errors[i].maximum, compare::difference(shown, judges[v]).maximum());
                if (done)
                    done(static_cast<double>(++count) / static_cast<double>(views.size() * settings.size()));
            }
    for (std::size_t i = 0; i < settings.size(); ++i) errors[i].flip = spread_of(std::move(means[i]));
    return errors;
}

}  // namespace vrut::server::measure

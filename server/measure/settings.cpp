#include "measure/settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "mesh/detail_levels.hpp"

namespace vrut::server::measure {

namespace {

using Transparency = plan::Methods::Transparency;
using TextureFilter = plan::Methods::TextureFilter;

constexpr std::array kScales{0.25, 0.35, 0.5, 0.71, 1.0};
constexpr std::array kDetails{4.0, 2.0, 1.0, 0.5, 0.25, 0.0};  // by rising accuracy

struct Encoding {
    int quality;
    bool subsampled;
};
constexpr std::array kEncodings{Encoding{60, true}, Encoding{75, true}, Encoding{85, false},
                                Encoding{90, false}};

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

constexpr std::array kClipPlaneCounts{0, 1, 6};

/// One looks into the scene from its right; a box of six leaves 0.6 of it in each direction.
std::vector<scene::ClipPlane> clip_planes_of(const math::Bounds& bounds, int count) {
    std::vector<scene::ClipPlane> planes;
    planes.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        glm::dvec3 normal(0);
        normal[i / 2] = i % 2 == 0 ? 1 : -1;
        const double out = count > 1 ? 0.6 * bounds.half_extent()[i / 2] : 0;
        planes.push_back({normal, glm::dot(normal, bounds.center()) + out});
    }
    return planes;
}

Setting not_encoded() {
    Setting setting;
    setting.jpeg_quality = 0;
    return setting;
}

void add(std::vector<Setting>& settings, const Setting& setting) {
    if (std::find(settings.begin(), settings.end(), setting) == settings.end()) settings.push_back(setting);
}

}  // namespace

std::string name_of(const Setting& setting) {
    std::string name = "scale " + number(setting.scale) + ", " + std::to_string(setting.samples) +
                       (setting.samples == 1 ? " sample" : " samples");
    if (setting.detail > 0) name += ", detail " + number(setting.detail);
    if (setting.methods.light == plan::Methods::Lighting::vertex) name += ", light at vertices";
    if (setting.methods.transparency == Transparency::sorted) name += ", glass sorted";
    if (setting.methods.transparency == Transparency::per_pixel_lists)
        name += ", all glass in per-pixel lists";
    if (setting.methods.texture_filter == TextureFilter::anisotropic) name += ", textures anisotropic";
    if (setting.clip_planes > 0) name += ", clip planes " + std::to_string(setting.clip_planes);
    if (setting.jpeg_quality > 0)
        name += ", JPEG " + std::to_string(setting.jpeg_quality) + (setting.subsampled ? " 4:2:0" : " 4:4:4");
    return name;
}

protocol::Quality quality_of(const Setting& setting) {
    using protocol::Quality;
    Quality quality;
    quality.level = Quality::Level::moving;
    quality.scale = setting.scale;
    quality.samples = setting.samples;
    quality.detail = setting.detail;
    quality.jpeg_quality = setting.jpeg_quality;
    quality.subsampling = setting.subsampled ? Quality::Subsampling::yuv420 : Quality::Subsampling::yuv444;
    return quality;
}

Setting setting_of(const protocol::Quality& quality) {
    Setting setting;
    setting.scale = quality.scale;
    setting.samples = quality.samples;
    setting.detail = quality.detail;
    setting.jpeg_quality = quality.jpeg_quality;
    setting.subsampled = quality.subsampling == protocol::Quality::Subsampling::yuv420;
    return setting;
}

plan::View view_with(plan::View view, const Setting& setting) {
    const auto scaled = [&](int side) {
        return std::max(1, static_cast<int>(std::lround(side * setting.scale)));
    };
    view.width = scaled(view.width);
    view.height = scaled(view.height);
    view.samples = setting.samples;
    view.detail = setting.detail;
    view.methods = setting.methods;
    if (setting.clip_planes > 0) view.clip_planes = clip_planes_of(view.scene->bounds, setting.clip_planes);
    return view;
}

std::shared_ptr<const mesh::DetailLevels> detail_levels_of(
    const std::shared_ptr<const scene::PlacedScene>& scene) {
    auto levels = std::make_shared<const mesh::DetailLevels>(scene->scene);
    levels->wait();
    return levels;
}

bool has_levels(const plan::View& view) {
    if (!view.levels) return false;
    const std::size_t count = view.levels->scene()->geometries().size();
    for (std::size_t i = 0; i < count; ++i)
        if (!view.levels->of(static_cast<scene::Index>(i)).empty()) return true;
    return false;
}

std::vector<Setting> product(bool with_detail) {
    std::vector<Setting> settings;
    for (const double scale : kScales)
        for (const double detail : {0.0, 0.5, 1.0, 2.0})
            for (const int samples : {1, 4})
                for (const Encoding& encoding : kEncodings)
                    if ((detail == 0 || with_detail) && (samples == 1 || scale >= 0.5))
                        settings.push_back(
                            {scale, samples, detail, {}, 0, encoding.quality, encoding.subsampled});
    for (const int samples : {2, 8, 16})
        settings.push_back({1, samples, 0, {}, 0, samples == 16 ? 90 : 85, false});
    for (const Setting& setting : encodings()) add(settings, setting);
    Setting vertex, sorted;
    vertex.methods.light = plan::Methods::Lighting::vertex;
    sorted.methods.transparency = Transparency::sorted;
    settings.push_back(vertex);
    settings.push_back(sorted);
    return settings;
}

std::vector<Setting> candidates(bool with_detail) {
    std::vector<Setting> settings;
    for (const double scale : kScales)
        for (const double detail : {2.0, 0.5, 0.0})
            for (const Encoding& encoding : kEncodings)
                if ((detail == 0 || with_detail) && (encoding.quality != 90 || scale == 1) &&
                    (encoding.quality != 75 || scale >= 0.5))
                    settings.push_back({scale, 1, detail, {}, 0, encoding.quality, encoding.subsampled});
    return settings;
}

std::vector<Setting> in_full_colour(std::vector<Setting> settings) {
    for (Setting& setting : settings) setting.subsampled = false;
    return settings;
}

std::vector<Setting> details() {
    std::vector<Setting> settings;
    for (const double detail : kDetails) {
        settings.push_back(not_encoded());
        settings.back().detail = detail;
    }
    return settings;
}

std::vector<Setting> sample_counts() {
    std::vector<Setting> settings;
    for (const int samples : {1, 2, 4, 8, 16, 32}) {
        settings.push_back(not_encoded());
        settings.back().samples = samples;
    }
    return settings;
}

std::vector<Setting> lights() {
    std::vector<Setting> settings(2, not_encoded());
    settings.front().methods.light = plan::Methods::Lighting::vertex;
    return settings;
}

std::vector<Setting> transparencies() {
    std::vector<Setting> settings(3, not_encoded());
    settings[0].methods.transparency = Transparency::sorted;
    settings[1].methods.transparency = Transparency::per_pixel_lists;
    return settings;
}

std::vector<Setting> texture_filters() {
    std::vector<Setting> settings(2, not_encoded());
    settings.back().methods.texture_filter = TextureFilter::anisotropic;
    return settings;
}

std::vector<Setting> clip_plane_counts() {
    std::vector<Setting> settings(kClipPlaneCounts.size(), not_encoded());
    for (std::size_t i = 0; i < settings.size(); ++i) settings[i].clip_planes = kClipPlaneCounts[i];
    return settings;
}

std::vector<Setting> encodings() {
    std::vector<Setting> settings;
    for (const bool subsampled : {true, false})
        for (const int quality : {30, 45, 60, 75, 85, 90, 95, 100})
            settings.push_back({1, 1, 0, {}, 0, quality, subsampled});
    return settings;
}

}  // namespace vrut::server::measure

#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "measure/measure.hpp"
#include "measure/rows.hpp"

namespace vrut::server::measure {

/// A scene as it is measured.
struct Subject {
    std::string name, sha256;
    plan::View home;  ///< of the size that is measured
};

/// The four ways to draw, by the names that charts give them.
struct Mode {
    const char* name;
    plan::DrawMode mode;
    bool wireframe;
};
inline constexpr std::array kModes{Mode{"realistic", plan::DrawMode::realistic, false},
                                   Mode{"realistic wireframe", plan::DrawMode::realistic, true},
                                   Mode{"stylized", plan::DrawMode::stylized, false},
                                   Mode{"stylized wireframe", plan::DrawMode::stylized, true}};
plan::View in_mode(plan::View view, const Mode& mode);

/// True if quality_of() of engine/frame_quality.hpp always sends this mode in 4:4:4.
bool has_thin_lines(const Mode& mode);

/// Returns true if pictures of the same samples are judged by the reference in double precision.
bool is_traced(const Subject& subject);

/// What to measure, and into which rows.
struct Experiment {
    /// What pictures are judged by: nothing; kJudgeSamples samples a pixel; a picture of the same samples, by
    /// the reference in double precision where that takes no time, else by the exact methods; the mean of
    /// kFinerPixels² pixels of a picture as many times as wide and high.
    enum class Judge { none, many_samples, same_samples, finer_pixels };
    std::string chart, method = {};
    Subject subject;
    Mode mode = kModes[0];
    std::vector<Setting> settings;
    Judge judge = Judge::none;
    int frames = 12;
};

/// Ways to pick, as Laboratory::run_picking() asks them.
inline constexpr std::array kPickings{"ray in double", "picture of ids", "picture of ids, half size",
                                      "every triangle"};

inline constexpr int kJudgeSamples = 64, kFinerPixels = 4, kJudgedViews = 3;
inline constexpr int kTableFrames = 100;  ///< of the thesis's table 7.1

/// Of a scene: the four modes, then one thing after the other, and how it is picked.
std::vector<Experiment> experiments_of(const Subject& subject, int frames);
/// The same scene in other sizes.
std::vector<Experiment> sizes_of(const Subject& subject, int frames);
/// Triangle counts of the generated scenes, from 20,000 up to `most`.
std::vector<std::uint64_t> triangle_counts(std::uint64_t most);
/// Rings of `triangles` triangles, all in view.
std::shared_ptr<const scene::PlacedScene> rings(std::uint64_t triangles);

/// What measures, and keeps what was measured.
class Laboratory {
public:
    /// `machine`: its processor.
    Laboratory(renderer::Renderer& renderer, Rows& rows, std::string version, std::string machine)
        : renderer_(renderer),
          studio_(renderer),
          rows_(rows),
          version_(std::move(version)),
          machine_(std::move(machine)) {}

    /// Returns true if nothing of it is left to do.
    bool is_done(const Experiment& experiment) const;
    /// Measures what is not in the rows yet.
    void run(const Experiment& experiment, const PartDone& done);
    /// Picks at points of images by each of kPickings.
    void run_picking(const Subject& subject, const PartDone& done);

    const std::string& renderer() const { return renderer_.description(); }
    /// What is measured, without what came out.
    Row row_of(const Experiment& experiment, const Setting& setting) const;
    std::vector<Row> picking_rows(const Subject& subject) const;

private:
    Row picking_row(const Subject& subject, const std::string& method) const;
    scene::Image judge(const Experiment& experiment, const plan::View& view);
    std::vector<scene::Image> judges(const Experiment& experiment, std::span<const plan::View> views,
                                     const PartDone& done);

    renderer::Renderer& renderer_;
    Studio studio_;
    Rows& rows_;
    std::string version_, machine_;
};

}  // namespace vrut::server::measure

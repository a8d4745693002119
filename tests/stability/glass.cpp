// Studies of glass.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pictures.hpp"
#include "reference/reference.hpp"
#include "shapes.hpp"

namespace vrut::stability {

namespace {

/// Of a colour that no light changes.
scene::Material glass(const glm::dvec3& color, double alpha) {
    scene::Material material;
    material.emission = {color, 1};
    material.diffuse = {0, 0, 0, alpha};
    material.two_sided = true;
    return material;
}

/// One that its neighbours do not have.
glm::dvec3 color_of(int pane) {
    return {0.2 + 0.6 * (pane % 2), 0.3 + 0.5 * (pane % 3) / 2, 0.8 - 0.6 * (pane % 2)};
}

template <class Make>
std::vector<Part> panes_of(double count, const Make& make) {
    std::vector<Part> panes;
    panes.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < static_cast<int>(count); ++i) panes.push_back(make(i));
    return panes;
}

/// Adds to both curves how far panes are from the reference: as wholes one after the other, and sorted at
/// each pixel where they have no order.
void compare_orders(const Laboratory& laboratory, Study& study, double count,
                    const std::vector<Part>& panes) {
    study.baseline.title = "sorted, pane by pane";
    study.method.title = "in order at each pixel, where panes have none";
    plan::View view = looking(scene_of(panes), {0.4, 0.7, 3.2});
    const scene::Image right = truth_of(view);
    study.method.points.push_back({count, percent_off(drawn(laboratory, view), right)});
    const double exact_ms = time_of(laboratory, view);
    view.methods.transparency = plan::Methods::Transparency::sorted;
    study.baseline.points.push_back({count, percent_off(drawn(laboratory, view), right)});
    study.cost = "Here " + times_the_time(exact_ms, time_of(laboratory, view)) +
                 " for the most panes, which is all in the picture; nothing where panes have an order.";
}

}  // namespace

Study crossing_panes(const Laboratory& laboratory) {
    Study study{"panes", "Panes of glass that cross in one line", "panes",
                "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.1;
    study.explanation =
        "Only the groups of panes that no order puts right are sorted at each pixel; all others are drawn "
        "from far to near.";
    for (const double count : laboratory.chosen({1, 2, 3, 4, 6, 8, 12, 16})) {
        const auto panes = panes_of(count, [&](int i) {
            return Part{i + 1, quad(1), glass(color_of(i), 0.5),
                        turned_by(180.0 * i / count + 10, {0, 1, 0})};
        });
        compare_orders(laboratory, study, count, panes);
    }
    return study;
}

Study rings_of_panes(const Laboratory& laboratory) {
    Study study{"rings", "Panes of glass in a ring, each partly before the next", "panes",
                "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.1;
    study.explanation =
        "Rings are found as strong components of what lies before what, and sorted at each pixel; what lies "
        "before or behind the ring is not.";
    for (const double count : laboratory.chosen({1, 2, 3, 4, 5, 6, 8, 12})) {
        // Along the sides of a polygon, each leaning so that one end is before its neighbour. Of two or fewer
        // there is none.
        constexpr double kRadius = 0.7, kLean = 0.2;
        const double half = count < 3 ? kRadius : 1.3 * kRadius * std::tan(std::numbers::pi / count) + 0.1;
        const auto panes = panes_of(count, [&](int i) {
            return Part{i + 1, quad(1), glass(color_of(i), 0.5),
                        turned_by(360.0 * i / count, {0, 0, 1}) * moved_by({kRadius, 0, 0}) *
                            turned_by(glm::degrees(std::asin(kLean / half)), {1, 0, 0}) *
                            scaled_by({0.25, half, 1})};
        });
        compare_orders(laboratory, study, count, panes);
    }
    return study;
}

Study many_panes(const Laboratory& laboratory) {
    Study study{"many-panes", "Many small panes of glass, at all angles", "panes",
                "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.5;  // each has edges, whose pixels may fall to either side
    study.explanation =
        "An order is looked for among a million pairs that overlap in the width of the screen. Where there "
        "are more, all glass is sorted at each pixel if no more than 64 panes lie over each other on "
        "average, and else drawn by its distance.";
    for (const double count : laboratory.chosen({10, 30, 100, 500, 1000, 2000, 4000})) {
        Noise noise;
        const auto panes = panes_of(count, [&](int i) {
            const glm::dvec3 place{noise.next(), noise.next(), noise.next()};
            const glm::dvec3 axis{noise.next(), noise.next(), noise.next()};
            return Part{i + 1, quad(0.1), glass(color_of(i), 0.5),
                        moved_by(place) * turned_by(180 * noise.next(), glm::normalize(axis))};
        });
        compare_orders(laboratory, study, count, panes);
    }
    return study;
}

namespace {

/// Adds to the study how far panes are from the reference that lie closer and closer together, in any order
/// in the file.
void compare_close_panes(const Laboratory& laboratory, Study& study, bool nearer_is_higher) {
    constexpr int kPanes = 5;
    const auto panes = [&](double gap, bool higher) {
        return panes_of(kPanes, [&](int i) {
            return Part{
                higher ? i + 1 : kPanes - i, quad(1), glass(color_of(i), 0.5),
                turned_by(35, glm::normalize(glm::dvec3(1, 1, 0))) * moved_by({0.1 * i, 0.07 * i, gap * i})};
        });
    };
    const auto view_of = [](const std::vector<Part>& parts) {
        return looking(scene_of(parts), {0.4, 0.7, 5});
    };
    for (const double inverse : laboratory.chosen({1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e9, 1e12, 1e18})) {
        // Where no pixel shows the distance, it must not decide either.
        const scene::Image right = truth_of(view_of(panes(std::max(2 / inverse, 1e-9), true)));
        std::vector<Part> parts = panes(2 / inverse, nearer_is_higher);
        double worst = 0;
        for (int i = 0; i < kPanes; ++i) {
            std::rotate(parts.begin(), parts.begin() + 1, parts.end());
            if (i == 2) std::swap(parts[1], parts[3]);
            worst = std::max(worst, percent_off(drawn(laboratory, view_of(parts)), right));
        }
        study.method.points.push_back({inverse, worst});
    }
}

}  // namespace

Study panes_in_one_place(const Laboratory& laboratory) {
    Study study{"close-panes", "Panes of glass close together, in any order in the file",
                "side of a pane / its distance to the next", "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.1;
    study.limit = 1e6;
    study.method.title = "by what lies before what";
    study.explanation =
        "Panes closer than a millionth of their size count as one plane, and of those the one with the "
        "higher id is in front, wherever it stands in the file. Here the lower id is the nearer one. At a "
        "millionth, of three panes two count as one plane and two do not: depths decide, which graphics "
        "cards "
        "interpolate less precisely than llvmpipe.";
    study.cost = "None: ids stay as they are in the file.";
    compare_close_panes(laboratory, study, false);
    return study;
}

Study panes_by_id(const Laboratory& laboratory) {
    Study study{"panes-by-id", "Panes of glass close together, the nearer one with the higher id",
                "side of a pane / its distance to the next", "pixels off by more than 8 of 255, in percent"};
    study.bound = 0.1;
    study.method.title = "in one plane by their ids";
    study.explanation = "Who lays a film on glass gives it the higher id.";
    study.cost = "None: ids stay as they are in the file.";
    compare_close_panes(laboratory, study, true);
    return study;
}

Study nearly_opaque_panes(const Laboratory& laboratory) {
    Study study{"alpha", "Twelve panes of glass, from faint to nearly opaque", "alpha / (1 - alpha)",
                "largest error of a channel, of 255"};
    study.bound = 1;
    study.baseline.title = "weighted means, which need no order (computed)";
    study.method.title = "one over the other, in 16 bits";
    study.explanation =
        "Layers are composited in their order, into 16 bits a channel: of what lies behind them the panes "
        "let 1 - alpha through, each. Behind alpha 0.9 two more layers can change a byte, above 0.998 none.";
    study.cost =
        "Colours take twice the bytes on the GPU in pictures with glass, and an order has to be found.";
    constexpr int kPanes = 12;
    for (const double odds :
         laboratory.chosen({0.01, 0.02, 0.05, 0.1, 0.3, 1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7})) {
        const double alpha = odds / (1 + odds);
        glm::dvec3 mean(0);
        for (int i = 0; i < kPanes; ++i) mean += color_of(i) / (1.0 * kPanes);
        double worst = 0, worst_of_mean = 0;
        // One behind the other, and all crossing in one line.
        for (const bool crossing : {false, true}) {
            const auto panes = panes_of(kPanes, [&](int i) {
                return Part{i + 1, quad(20), glass(color_of(i), alpha),
                            crossing ? turned_by(3 * i - 16, {0, 1, 0}) : moved_by({0, 0, -0.2 * i})};
            });
            plan::View view = looking(scene_of(panes), {0, 0, 3});
            view.width = view.height = 16;
            const scene::Image image = drawn(laboratory, view);
            const std::vector<glm::dvec3> right = reference::trace(view).color;
            const double through = std::pow(1 - alpha, kPanes);
            const glm::dvec3 weighted = glm::mix(mean, view.background.color, through);
            for (std::size_t i = 0; i < right.size(); ++i) {
                const glm::dvec3 shown(image.rgba[4 * i], image.rgba[4 * i + 1], image.rgba[4 * i + 2]);
                const glm::dvec3 off = glm::abs(shown - 255.0 * right[i]);
                const glm::dvec3 off_of_mean = 255.0 * glm::abs(weighted - right[i]);
                worst = std::max({worst, off.x, off.y, off.z});
                worst_of_mean = std::max({worst_of_mean, off_of_mean.x, off_of_mean.y, off_of_mean.z});
            }
        }
        study.baseline.points.push_back({odds, worst_of_mean});
        study.method.points.push_back({odds, worst});
    }
    return study;
}

}  // namespace vrut::stability

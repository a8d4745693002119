// Every method pushed as far as its limit, in short. The program `stability` does it in full, as a page.
#include <doctest/doctest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "gl/handles.hpp"
#include "stability_page.hpp"
#include "study.hpp"

using namespace vrut;
using namespace vrut::stability;

namespace {

/// The results that the table of LIMITS.md is made from, by the names of their studies.
std::map<std::string, nlohmann::json> kept_results() {
    std::map<std::string, nlohmann::json> results;
    std::ifstream file(VRUT_TEST_DATA "/results.json");
    for (const nlohmann::json& study : nlohmann::json::parse(file)) results[study["study"]] = study;
    return results;
}

/// Whether they are of a study as it is now.
bool is_of(const nlohmann::json& result, const Study& study) {
    const bool same_limit =
        study.limit ? result.value("limit", -1.0) == *study.limit : !result.contains("limit");
    return same_limit && result["bound"] == study.bound && result["measure"] == study.measure &&
           result["parameter"] == study.parameter && result["method"] == study.method.title;
}

/// A frame that is warped is no farther from the truth than the frame as it is, up to the limit.
bool is_worth_it(const Study& study) {
    if (!study.file.starts_with("warped-")) return true;
    constexpr double kNothingSeen = 0.1;  // percent of FLIP
    for (std::size_t i = 0; i < study.method.points.size(); ++i) {
        const auto &warped = study.method.points[i], &waited = study.baseline.points.at(i);
        if (study.limit && warped.x >= *study.limit) break;
        if (warped.y > waited.y + kNothingSeen) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("each method holds up to its limit") {
    const auto results = kept_results();
    CHECK(results.size() == topics().size());
    {
        renderer::Renderer renderer(std::nullopt, true);
        const Laboratory laboratory{renderer, Form::brief};
        for (const Topic& topic : topics()) {
            CAPTURE(std::string(topic.name));
            const Study study = topic.study(laboratory);
            const auto why = failure(study);
            CHECK_MESSAGE(!why, *why);
            CHECK_MESSAGE(
                (results.count(study.file) && is_of(results.at(study.file), study)),
                "the results in data/ are of an older study: run `stability FOLDER`, then limits.mjs");
            CHECK(study.measure.size() <= 60);  // what stands along the height of its chart
            CHECK(is_worth_it(study));
            for (const std::string& message : renderer.take_messages()) FAIL_CHECK(message);
        }
    }
    CHECK(gl::live_gl_objects() == 0);
}

TEST_CASE("a study fails where its method does before its limit, or was not measured") {
    const Study good{"x", "", "", "", 1, 10, {"m", {{1, 0.5}, {10, 2}}}, {"b", {{1, 3}}}, "", ""};
    CHECK(!failure(good));
    const auto with = [&](auto change) {
        Study study = good;
        change(study);
        return failure(study).value_or("");
    };
    CHECK(with([](Study& study) { study.method.points.clear(); }) == "'m' was not measured");
    CHECK(with([](Study& study) { study.method.points[0].y = std::nan(""); }) == "'m' is nan at 1");
    CHECK(with([](Study& study) { study.method.points[1].y = kNothing; }) == "'m' returned nothing at 10");
    CHECK(with([](Study& study) { study.baseline.points[0].y = kNothing; }) == "'b' returned nothing at 1");
    CHECK(with([](Study& study) { study.method.points[0].y = 1.5; }) == "'m' is 1.5 at 1, above 1");
    CHECK(with([](Study& study) { study.limit = 11; }) == "'m' is 2 at 10, above 1");
    CHECK(with([](Study& study) { study.method.points.pop_back(); }) == "'m' was not pushed as far as 10");
    CHECK(with([](Study& study) { study.limit.reset(); }) == "'m' is 2 at 10, above 1");
}

TEST_CASE("a method that does better than its limit does not fail, and is told of") {
    Study study{"x", "", "", "", 1, 10, {"m", {{1, 0.5}, {10, 0.75}}}, {}, "", ""};
    CHECK(!failure(study));
    CHECK(improvement(study).value_or("") == "'m' is 0.75 at 10 and holds: the limit can be told as better");
    study.method.points[1].y = 2;
    CHECK(!improvement(study));
}

TEST_CASE("a method that got exact is drawn, though no measure is above 0") {
    const Study study{"x", "", "", "", 0, {}, {"m", {{1, 0}, {10, 0}}}, {"b", {{1, 0}, {10, 0}}}, "", ""};
    CHECK(!failure(study));
    const auto section = section_of(study);
    REQUIRE(section.plots.size() == 1);
    CHECK(section.plots[0].floor.value_or(0) > 0);
    CHECK(std::isfinite(section.plots[0].floor.value_or(0)));
}

#include "render_job.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace vrut::protocol;
using nlohmann::json;

namespace {

RenderJob job_example() {
    RenderJob job;
    job.run = "a1";
    job.image = 7;
    job.scene = "car.vrut";
    job.sha256 = "ab12";
    job.up_axis = UpAxis::z;
    job.studio = RenderJob::Studio::off;
    job.width = 320;
    job.height = 180;
    job.samples = 16;
    job.detail = 0.1;
    job.format = ImageFormat::png;
    job.patches = {"{}", R"({"renderer":{"wireframe":true}})"};
    job.camera.eye = {0.1, 1.0 / 3, -2e5};
    job.camera.focus = {1e-7, 0, 5e-324};
    job.camera.up = {0.2, 0.9, 0.1};
    job.camera.center = {1, 2, 3};
    job.camera.fov = 33.3;
    return job;
}

/// What is said of the example with one value set; null: without it.
std::string job_rejection(const std::string& member, const json& value) {
    json changed = json::parse(encode(job_example()));
    changed[json::json_pointer("/" + member)] = value;
    if (value.is_null()) changed.erase(member);
    const auto job = parse_render_job(changed.dump());
    return job ? "" : job.error();
}

}  // namespace

TEST_CASE("a job reads back as it was written, to the last bit") {
    const RenderJob job = job_example();
    const auto read = parse_render_job(encode(job));
    REQUIRE(read.has_value());
    CHECK(read->camera == job.camera);
    CHECK(read->detail == job.detail);
    CHECK(read->patches == job.patches);
    CHECK(encode(*read) == encode(job));
}

TEST_CASE("an invalid job is rejected with a sentence that names the member") {
    CHECK(job_rejection("samples", 4096) == "");
    CHECK(job_rejection("samples", 4097).starts_with("'samples'"));
    CHECK(job_rejection("image", 0).starts_with("'image'"));
    CHECK(job_rejection("width", 8193).starts_with("'width'"));
    CHECK(job_rejection("upAxis", "x").starts_with("'upAxis'"));
    CHECK(job_rejection("format", "gif").starts_with("'format'"));
    CHECK(job_rejection("detail", -1).starts_with("'detail'"));
    CHECK(job_rejection("camera/fov", 171).starts_with("'camera.fov'"));
    CHECK(job_rejection("patches", json::array({1})).starts_with("'patches[0]'"));
    CHECK(job_rejection("sha256", nullptr) == "member 'sha256' is missing");
    CHECK(job_rejection("camera", json::object()) == "'camera' must have eye, focus, up, center and fov");
    CHECK(parse_render_job("[]").error() == "a job must be a JSON object");
    CHECK(!parse_render_job("garbage").has_value());
    CHECK(!parse_render_job("").has_value());
}

#include "render_job.hpp"

#include "file_descriptions.hpp"

namespace vrut::protocol {

namespace {

RenderJob checked(RenderJob job) {
    const CameraOverlay& camera = job.camera;
    if (!camera.eye || !camera.focus || !camera.up || !camera.center || !camera.fov)
        throw BadJson{error_code::bad_message, "'camera' must have eye, focus, up, center and fov"};
    return job;
}

}  // namespace

std::string encode(const RenderJob& job) { return dump(write_struct(job)); }

tl::expected<RenderJob, std::string> parse_render_job(std::string_view text) {
    return or_error([&] {
               const Json json = parse_strictly(text);
               if (!json.is_object()) throw BadJson{error_code::bad_message, "a job must be a JSON object"};
               return checked(read_struct<RenderJob>(json, ""));
           })
        .map_error([](const Error& error) { return error.message; });
}

}  // namespace vrut::protocol

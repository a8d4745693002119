#include <array>

#include "base/drawing_errors.hpp"
#include "codec.hpp"
#include "engine/engine.hpp"
#include "observe/log.hpp"

// What draws, and what goes on when it fails.
namespace vrut::server::engine {

namespace code = protocol::error_code;
using namespace std::chrono_literals;

namespace {

/// Before each try to make a renderer anew, since a driver may need a moment: 3.1 s in all.
constexpr std::array kPauses{0ms, 100ms, 200ms, 400ms, 800ms, 1600ms};

constexpr std::int64_t kFewestPixels = 4096;  // of a live picture

}  // namespace

/// One step.
Engine::Drawn Engine::draw(plan::RenderJob& job) {
    const int samples = job.stats.samples;
    const int readbacks = job.stats.readbacks;
    try {
        const bool whole = renderer_.step(job);
        metrics_.samples_drawn += static_cast<std::uint64_t>(job.stats.samples - samples);
        metrics_.readbacks += static_cast<std::uint64_t>(job.stats.readbacks - readbacks);
        if (renderer_.gl_objects) metrics_.gl_objects = static_cast<std::uint64_t>(renderer_.gl_objects());
        if (!whole) return Drawn::part;
        draws_ = true;
        tries_ = 0;
        return Drawn::whole;
    } catch (const vrut::base::ContextLost& lost) {
        lose_renderer(lost.what());
        return Drawn::lost;
    }
}

/// Scene, state and clients know nothing of it.
void Engine::lose_renderer(const std::string& why) {
    draws_ = false;
    renderer_ = {};
    observe::log_warning("drawing_begins_anew", {{"reason", why}});
    const auto pause = tries_ < kPauses.size() ? kPauses[tries_] : 0ms;
    renewal_ = Renewal{base::Clock::now() + pause, why};
}

/// Throws where none can be had, or each is lost at once.
void Engine::renew_renderer() {
    if (tries_++ == kPauses.size()) throw std::runtime_error(renewal_->why);
    try {
        renderer_ = factory_();
    } catch (const std::exception& error) {
        return lose_renderer(error.what());
    }
    renewal_.reset();
    notice({protocol::notice_code::driver_restarted,
            "The graphics driver had to be started again; drawing goes on with " + renderer_.description});
}

/// Uploads one step of the scene that has arrived, and shows it once all is there: until then frames of the
/// old scene are drawn between the steps. Where the upload fails, the old scene stays.
void Engine::show_arrived() {
    if (renewal_) return;
    std::optional<std::string> rejected;
    const scenes::SceneLoaded& loaded = arrived_->loaded;
    if (!loaded.scene) {
        rejected = loaded.scene.error();
    } else if (renderer_.upload_step) {
        const scenes::LoadedScene& next = *loaded.scene;
        try {
            if (!renderer_.upload_step(arrived_->view)) return;
        } catch (const vrut::base::OutOfMemory& error) {
            rejected = next.name + ": " + error.what();
        } catch (const vrut::base::ContextLost& lost) {
            lose_renderer(lost.what());
            if (++arrived_->losses < kMostLosses) return;
            rejected = next.name + ": the graphics driver is lost whenever it gets this scene";
        } catch (const std::exception& error) {
            rejected = next.name + ": " + error.what();
        }
    }
    show(std::exchange(arrived_, std::nullopt)->loaded, std::move(rejected));
}

void Engine::show(const scenes::SceneLoaded& loaded, std::optional<std::string> rejected) {
    loader_.finish();
    protocol::Loading loading{loaded.name, 1, {}, std::move(rejected)};
    if (loading.refused) {
        observe::log_warning("scene_refused", {{"scene", loaded.name}, {"reason", *loading.refused}});
    } else {
        keep_changes();
        scenes::LoadedScene scene = prepared(*loaded.scene);
        // What was read may be older.
        if (const auto newer = change_keeper_.newest(scene.changes_key())) {
            scene.changes = *newer;
            scene.changes_fault.reset();
        }
        room_->show(std::move(scene), time_of(base::Clock::now()));
        note_kept();
        set_changes_aside();
        use(loaded.levels);
        pixel_budget_ = limits_;
        last_change_ = base::Clock::now();
        loading.done = true;
        observe::log_info("scene_shown", {{"scene", loaded.name},
                                          {"triangles", loaded.scene->placed->scene->triangle_count()}});
    }
    broadcast(loading);
}

/// A live picture of this size does not fit: one of a quarter of its pixels may.
void Engine::draw_smaller(const Failed& what, const PictureSize& size, const std::string& why) {
    const std::int64_t pixels = std::int64_t{size.width} * size.height / 4;
    observe::log_warning("picture_too_large",
                         {{"width", size.width}, {"height", size.height}, {"reason", why}});
    if (pixels >= kFewestPixels) {
        pixel_budget_.max_pixels = pixels;
        return notice({protocol::notice_code::smaller, "Memory is short: frames are drawn smaller"});
    }
    failed_ = what;
    notice({protocol::notice_code::no_memory, "Memory is short: this view cannot be drawn"});
}

bool Engine::has_failed() const {
    return failed_ && failed_->visible == room_->visible() && failed_->view_size == room_->view_size();
}

void Engine::reject(const Snapshot& snapshot, const std::string& sentence) {
    reject(snapshot.order.client, snapshot.order.header.snapshot, sentence);
}

/// Answers who asked for a picture: a client, or by HTTP somebody else.
void Engine::reject(const std::string& client, std::optional<std::int64_t> id, const std::string& sentence) {
    if (id && clients_.contains(client)) {
        --clients_[client].snapshots;
        room_->reject(client, {*id, code::failed, sentence});
    } else if (!id) {
        output_.failed_pictures.push_back(client);
    }
}

void Engine::notice(const protocol::Notice& notice) {
    observe::log_warning("notice", {{"code", notice.code}, {"text", notice.message}});
    // Those of a room that another server draws come from that one.
    if (follows_) return held_notices_.push_back(notice);
    room_->notice(notice);
}

}  // namespace vrut::server::engine

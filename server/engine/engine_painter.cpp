#include <array>

#include "codec.hpp"
#include "drawing_errors.hpp"
#include "engine/engine.hpp"
#include "observe/log.hpp"

// What draws, and what goes on when it fails.
namespace vrut::server::engine {

namespace code = protocol::error_code;
using namespace std::chrono_literals;

namespace {

/// Before each try to make a painter anew, since a driver may need a moment: 3.1 s in all.
constexpr std::array kPauses{0ms, 100ms, 200ms, 400ms, 800ms, 1600ms};

constexpr std::int64_t kFewestPixels = 4096;  // of a live picture

}  // namespace

Engine::Painted Engine::paint(const View& view, Image& image, FrameStats& stats,
                              const std::function<bool()>& interrupted, Accumulation* kept) {
    try {
        const bool whole = painter_.paint(view, image, stats, interrupted, kept);
        draws_ = draws_ || whole;
        metrics_.samples_drawn += static_cast<std::uint64_t>(stats.samples);
        metrics_.readbacks += static_cast<std::uint64_t>(stats.readbacks);
        if (painter_.gl_objects) metrics_.gl_objects = static_cast<std::uint64_t>(painter_.gl_objects());
        if (whole) tries_ = 0;
        return whole ? Painted::whole : Painted::given_up;
    } catch (const ContextLost& lost) {
        if (kept) *kept = {};
        renew_painter(lost.what());
        return Painted::lost;
    }
}

/// Scene, state and clients know nothing of it. Throws where none can be had, or each is lost at once.
void Engine::renew_painter(std::string why) {
    draws_ = false;
    painter_ = {};
    while (!painter_.paint) {
        observe::log_warning("drawing_begins_anew", {{"reason", why}});
        if (tries_ == kPauses.size()) throw std::runtime_error(why);
        const base::Clock::time_point end = base::Clock::now() + kPauses[tries_++];
        while (base::Clock::now() < end && !mailbox_.closed()) {
            receive(end);
            attend();
        }
        if (mailbox_.closed()) return;
        try {
            painter_ = factory_();
        } catch (const std::exception& error) {
            why = error.what();
        }
    }
    notice("The graphics driver had to be started again; drawing goes on with " + painter_.description);
}

/// Before it is shown; why it cannot be, if so: then the one that is shown goes on.
std::optional<std::string> Engine::take(const scene::LoadedScene& scene) {
    if (!painter_.take) return std::nullopt;
    const View first = room::view_of(room::starting_state(*scene.placed, 1, {}), scene.placed);
    for (int losses = 0; losses < kMostLosses; ++losses) {
        try {
            painter_.take(first);
            return std::nullopt;
        } catch (const OutOfMemory& error) {
            return scene.name + ": " + error.what();
        } catch (const ContextLost& lost) {
            renew_painter(lost.what());
            if (mailbox_.closed()) return std::nullopt;
        }
    }
    return scene.name + ": the graphics driver is lost whenever it gets this scene";
}

void Engine::show(const scene::SceneLoaded& loaded) {
    loader_.finish();
    protocol::Loading told{loaded.name, 1, {}, {}};
    if (loaded.scene)
        told.refused = take(*loaded.scene);
    else
        told.refused = loaded.scene.error();
    if (told.refused) {
        observe::log_warning("scene_refused", {{"scene", loaded.name}, {"reason", *told.refused}});
    } else {
        presentation_->show(with_notices(*loaded.scene), time_of(base::Clock::now()));
        use(loaded.levels);
        room_ = limits_;
        last_change_ = base::Clock::now();
        told.done = true;
        observe::log_info("scene_shown", {{"scene", loaded.name},
                                          {"triangles", loaded.scene->placed->scene->triangle_count()}});
    }
    tell(told);
}

/// A live picture of this size does not fit: one of a quarter of its pixels may.
void Engine::draw_smaller(const Undrawable& what, const PictureSize& size, const std::string& why) {
    const std::int64_t pixels = std::int64_t{size.width} * size.height / 4;
    observe::log_warning("picture_too_large",
                         {{"width", size.width}, {"height", size.height}, {"reason", why}});
    if (pixels >= kFewestPixels) {
        room_.max_pixels = pixels;
        return notice("Memory is short: pictures are drawn smaller");
    }
    undrawable_ = what;
    notice("Memory is short: what is to be seen now cannot be drawn");
}

bool Engine::is_undrawable() const {
    return undrawable_ && undrawable_->visible == presentation_->visible() &&
           undrawable_->view_size == presentation_->view_size();
}

void Engine::refuse(const Snapshot& snapshot, const std::string& sentence) {
    const std::string& client = snapshot.order.client;
    const auto& id = snapshot.order.header.snapshot;
    if (id && clients_.contains(client)) {
        --clients_[client].snapshots;
        presentation_->refuse(client, {*id, code::failed, sentence});
    } else if (!id) {
        output_.undrawn.push_back(client);
    }
}

void Engine::notice(const std::string& sentence) {
    observe::log_warning("notice", {{"text", sentence}});
    presentation_->notice(sentence);
}

}  // namespace vrut::server::engine

// Scenes and recordings: what takes a disk is done elsewhere, and comes back as an event.
#include "engine/engine.hpp"
#include "scenes/level_store.hpp"

namespace vrut::server::engine {

namespace code = protocol::error_code;

void Engine::connect_files(room::RoomOptions& options) {
    options.load = [this](std::int64_t request, const protocol::Open& asked) {
        lookup_.find(request, asked, base::Clock::now());
    };
    options.scenes = [this](std::int64_t request) { lookup_.list(request, base::Clock::now()); };
    if (record_folder_.empty()) return;
    room::RecordingSink& sink = options.recordings.emplace();
    sink.begin = [this](std::int64_t recording, const std::string& name, const auto& header) {
        recordings_.begin(recording, name, header, base::Clock::now());
    };
    sink.write = [this](std::int64_t recording, std::string line) {
        recordings_.write(recording, std::move(line), base::Clock::now());
    };
    sink.end = [this](std::int64_t recording) { recordings_.end(recording, base::Clock::now()); };
}

/// The levels of `scene`, which is shown first, as they were measured on this machine.
void Engine::read_levels(const scenes::LoadedScene& scene) {
    run_file_work(
        [this, post = file_results_, shown = scene.placed, sha256 = scene.sha256, renderer = description_] {
            post->send([this, shown, table = scenes::levels_of(sha256, renderer)] {
                if (room_->scene().scene == shown->scene) use(table);
            });
        });
}

std::optional<base::Clock::time_point> Engine::files_due() const {
    std::optional<base::Clock::time_point> first;
    for (const auto due : {lookup_.due(), recordings_.due(), change_keeper_.due()})
        if (due) first = std::min(first.value_or(*due), *due);
    return first;
}

bool Engine::has_changes_to_keep() const { return !protocol::has_equal_kept(room_->state(), kept_); }

void Engine::check_changes() {
    const base::Clock::time_point now = base::Clock::now();
    if (has_changes_to_keep()) change_keeper_.changed(now);
    if (const auto due = change_keeper_.due(); due && now >= *due) keep_changes();
}

/// Those of the scene that is shown.
void Engine::keep_changes() {
    if (!has_changes_to_keep()) return;
    change_keeper_.keep(room_->changes_key(), room_->changes());
    note_kept();
}

/// What is kept of the scene that is shown, if it cannot be used.
void Engine::set_changes_aside() {
    if (const auto unusable = room_->unusable_changes())
        change_keeper_.set_aside(room_->changes_key(), *unusable);
}

/// What stands now is kept already.
void Engine::note_kept() { kept_ = room_->state(); }

void Engine::check_files() {
    const base::Clock::time_point now = base::Clock::now();
    lookup_.check(now);
    recordings_.check(now);
}

void Engine::handle(const FileWorkDone& done) {
    const plan::View before = room_->visible();
    const protocol::Resize size_before = room_->view_size();
    done.use();
    if (room_->visible() != before || room_->view_size() != size_before) last_change_ = base::Clock::now();
}

/// Begins to load a scene that was looked for, or says why not.
std::optional<protocol::Error> Engine::load(const SceneLookup::Found& found) {
    if (!found.path) return found.path.error();
    const protocol::Open& asked = found.asked;
    if (asked.up_axis && !io::lacks_up_axis(*found.path))
        return protocol::Error{{},
                               code::refused_scene,
                               asked.scene + ": its format defines which axis is up: leave out 'upAxis'"};
    if (loader_.busy()) return protocol::Error{{}, code::busy, "a scene is being loaded already"};
    try {
        loader_.start(*found.path, asked, description_, library_.options());
    } catch (const std::system_error& error) {
        return protocol::Error{{}, code::failed, "a scene cannot be loaded now: " + error.code().message()};
    }
    broadcast({asked.scene, 0, {}, {}});
    return std::nullopt;
}

}  // namespace vrut::server::engine

#include "room/recordings.hpp"

namespace vrut::server::room {

const Recording* Recordings::active() const {
    if (recordings_.empty()) return nullptr;
    const Recording& newest = recordings_.rbegin()->second;
    return newest.stop ? nullptr : &newest;
}

void Recordings::begin(const std::string& name, RecordingSink::Header header, SessionTime now,
                       AnsweredLater start) {
    sink_->begin(++newest_, name, std::move(header));
    recordings_[newest_] = {now, {}, std::move(start)};
}

void Recordings::write(SessionTime now, const std::string& client, decltype(protocol::LogLine::what) what) {
    if (const Recording* recording = active())
        sink_->write(newest_,
                     protocol::encode(protocol::LogLine{now - recording->since, client, std::move(what)}));
}

void Recordings::end(AnsweredLater stop) {
    recordings_.rbegin()->second.stop = std::move(stop);
    sink_->end(newest_);
}

Recording* Recordings::find(std::int64_t recording) {
    const auto found = recordings_.find(recording);
    return found == recordings_.end() ? nullptr : &found->second;
}

std::optional<Recording> Recordings::take(std::int64_t recording) {
    auto found = recordings_.extract(recording);
    return found.empty() ? std::nullopt : std::optional(std::move(found.mapped()));
}

void Journal::write_revision(SessionTime now, std::int64_t revision, const protocol::State& state) {
    const std::string recording = state.recording ? state.recording->name : "";
    protocol::LogLine::Revised revised{revision, {}, {}};
    if (newest_.notices != state.notices) revised.notices = newest_.notices = state.notices;
    if (newest_.recording != recording) revised.recording = newest_.recording = recording;
    if (revision != std::exchange(newest_.revision, revision)) write(now, {}, revised);
}

}  // namespace vrut::server::room

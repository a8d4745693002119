#include "observe/live_stats.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "rights.hpp"

namespace vrut::server::observe {

namespace {

constexpr std::chrono::milliseconds kBetween{500};
constexpr std::size_t kPictures = 100, kRevisions = 4096;

double milliseconds(base::Clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

}  // namespace

void LiveStats::joined(const std::string& client, protocol::Role role, const std::string& name,
                       base::Clock::time_point now) {
    clients_[client] = {role, name, {}, {}};
    happened(now);
}

void LiveStats::left(const std::string& client, base::Clock::time_point now) {
    clients_.erase(client);
    happened(now);
}

void LiveStats::drawn(const protocol::Quality& quality, double render_ms, base::Clock::time_point now) {
    quality_ = quality;
    render_ms_.push_back(render_ms);
    if (render_ms_.size() > kPictures) render_ms_.pop_front();
    happened(now);
}

void LiveStats::made(std::int64_t revision, base::Clock::time_point now) {
    made_.emplace_back(revision, now);
    if (made_.size() > kRevisions) made_.pop_front();
}

void LiveStats::shown(const std::string& client, std::int64_t revision, base::Clock::time_point now) {
    const auto host = clients_.find(client);
    if (host == clients_.end()) return;
    const auto made =
        std::lower_bound(made_.begin(), made_.end(), revision,
                         [](const auto& entry, std::int64_t wanted) { return entry.first < wanted; });
    host->second.shown = revision;
    host->second.lag_ms.reset();
    // A revision between two that were made counts as the later one.
    if (made != made_.end() && made_.front().first <= revision)
        host->second.lag_ms = std::max(0.0, milliseconds(now - made->second));
    happened(now);
}

void LiveStats::happened(base::Clock::time_point now) {
    if (!happened_) happened_ = now;
}

std::optional<base::Clock::time_point> LiveStats::due() const {
    if (!happened_) return std::nullopt;
    return taken_at_ ? std::max(*taken_at_ + kBetween, *happened_) : *happened_;
}

std::optional<protocol::Stats::Renderer> LiveStats::renderer() const {
    if (render_ms_.empty()) return std::nullopt;
    std::vector<double> sorted(render_ms_.begin(), render_ms_.end());
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double part) {
        return sorted[static_cast<std::size_t>(std::lround(part * static_cast<double>(sorted.size() - 1)))];
    };
    const double sum = std::accumulate(sorted.begin(), sorted.end(), 0.0);
    return protocol::Stats::Renderer{sum / static_cast<double>(sorted.size()), at(0.5), at(0.95)};
}

std::optional<protocol::Stats> LiveStats::take(base::Clock::time_point now) {
    if (!due() || now < *due()) return std::nullopt;
    protocol::Stats stats;
    stats.renderer = renderer();
    stats.quality = quality_;
    for (const auto& [id, client] : clients_) {
        ++stats.clients;
        stats.watchers += !may(client.role, protocol::Right::present);
        if (may(client.role, protocol::Right::drive_walls) && client.shown)
            stats.hosts[id] = {client.name, *client.shown, client.lag_ms};
    }
    // Rates since the last take, or since things began to happen again after a rest.
    const base::Clock::time_point since = std::max(taken_at_.value_or(*happened_), *happened_ - kBetween);
    const double seconds = std::max(milliseconds(now - since), milliseconds(kBetween)) / 1000;
    const std::uint64_t frames = metrics_.frames_sent, bytes = metrics_.bytes_sent;
    stats.frames_per_second = static_cast<double>(frames - frames_) / seconds;
    stats.bytes_per_second = static_cast<double>(bytes - bytes_) / seconds;
    frames_ = frames;
    bytes_ = bytes;
    taken_at_ = now;
    happened_.reset();
    return stats;
}

}  // namespace vrut::server::observe

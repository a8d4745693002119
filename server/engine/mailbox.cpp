#include "engine/mailbox.hpp"

namespace vrut::server::engine {

namespace {

using protocol::Pointer;

/// A move that only says where the pointer is now: no button went down or up with it, and it does not say
/// what a drag that begins is about.
const Pointer* plain_move(const MessageReceived& received) {
    if (!received.message || !received.may_steer) return nullptr;
    const auto* pointer = std::get_if<Pointer>(&received.message->payload);
    const bool is_plain =
        pointer && pointer->event == Pointer::Event::move && pointer->button == -1 && !pointer->touched;
    return is_plain ? pointer : nullptr;
}

/// Lets `next` take the place of `before`, an earlier move of the same pointer.
bool merge(const MessageReceived& before, MessageReceived& next) {
    const Pointer *a = plain_move(before), *b = plain_move(next);
    if (a->buttons != b->buttons) return false;
    const auto id = before.message->id;
    if (id && next.message->id && *next.message->id <= *id) return false;
    next.bytes += before.bytes;
    if (!next.message->id) next.message->id = id;
    return true;
}

/// Takes out the move that `next` replaces: one among the moves of its client that came last. Moves of
/// several fingers take turns, so it need not be the very last.
void merge_into(std::vector<EngineEvent>& events, MessageReceived& next) {
    if (!plain_move(next)) return;
    bool last = true;
    for (auto event = events.rbegin(); event != events.rend(); ++event, last = false) {
        const auto* before = std::get_if<MessageReceived>(&*event);
        if (!before || before->client != next.client || !plain_move(*before)) return;
        // Ids rise: one that is inherited may not come behind a later one.
        if (!last && !next.message->id) return;
        if (plain_move(*before)->pointer_id != plain_move(next)->pointer_id) continue;
        if (merge(*before, next)) events.erase(std::next(event).base());
        return;
    }
}

}  // namespace

void Mailbox::push(EngineEvent event) {
    {
        const std::lock_guard lock(mutex_);
        if (const auto* left = std::get_if<ClientLeft>(&event))
            std::erase_if(events_, [&](const EngineEvent& waiting) {
                const auto* received = std::get_if<MessageReceived>(&waiting);
                return received && received->client == left->client;
            });
        if (auto* received = std::get_if<MessageReceived>(&event)) merge_into(events_, *received);
        if (const auto* wanted = std::get_if<FramesWanted>(&event))
            std::erase_if(events_, [&](const EngineEvent& waiting) {
                const auto* before = std::get_if<FramesWanted>(&waiting);
                return before && before->client == wanted->client;
            });
        events_.push_back(std::move(event));
    }
    condition_.notify_one();
}

void Mailbox::wake() {
    {
        const std::lock_guard lock(mutex_);
        woken_ = true;
    }
    condition_.notify_one();
}

void Mailbox::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    condition_.notify_one();
}

bool Mailbox::closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
}

std::size_t Mailbox::size() const {
    const std::lock_guard lock(mutex_);
    return events_.size();
}

std::vector<EngineEvent> Mailbox::wait(std::optional<base::Clock::time_point> until) {
    std::unique_lock lock(mutex_);
    const auto ready = [&] { return !events_.empty() || woken_ || closed_; };
    if (until)
        condition_.wait_until(lock, *until, ready);
    else
        condition_.wait(lock, ready);
    woken_ = false;
    return std::exchange(events_, {});
}

}  // namespace vrut::server::engine

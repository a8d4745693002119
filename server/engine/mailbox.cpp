#include "engine/mailbox.hpp"

namespace vrut::server::engine {

namespace {

using protocol::Pointer;

/// A move that only says where the pointer is now: no button went down or up with it.
const Pointer* plain_move(const ClientSaid& said) {
    if (!said.message || !said.may_steer) return nullptr;
    const auto* pointer = std::get_if<Pointer>(&said.message->payload);
    return pointer && pointer->event == Pointer::Event::move && pointer->button == -1 ? pointer : nullptr;
}

/// Lets `next` take the place of `last` where both are moves of one pointer.
bool merge(EngineEvent& last, const EngineEvent& next) {
    auto* before = std::get_if<ClientSaid>(&last);
    const auto* after = std::get_if<ClientSaid>(&next);
    if (!before || !after || before->client != after->client) return false;
    const Pointer *a = plain_move(*before), *b = plain_move(*after);
    if (!a || !b || a->pointer_id != b->pointer_id || a->buttons != b->buttons) return false;
    if (before->message->id && after->message->id && *after->message->id <= *before->message->id)
        return false;
    const std::size_t bytes = before->bytes;
    const auto id = before->message->id;
    *before = *after;
    before->bytes += bytes;
    if (!before->message->id) before->message->id = id;
    return true;
}

}  // namespace

void Mailbox::push(EngineEvent event) {
    {
        const std::lock_guard lock(mutex_);
        if (const auto* left = std::get_if<ClientLeft>(&event))
            std::erase_if(events_, [&](const EngineEvent& waiting) {
                const auto* said = std::get_if<ClientSaid>(&waiting);
                return said && said->client == left->client;
            });
        if (!events_.empty() && merge(events_.back(), event)) return;
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

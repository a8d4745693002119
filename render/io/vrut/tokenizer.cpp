#include "io/vrut/tokenizer.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

namespace vrut::io {

namespace {

static_assert(kChunkBytes > 2 * kMaxTokenBytes, "each chunk gets somewhere");

std::string compact(double value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    return std::string(buffer, end);
}

/// Where a chunk that is not the last ends: behind its last line break, where a text is always between two
/// tokens, or in a longer line before its last character.
std::size_t end_of_chunk(std::string_view text) {
    if (const std::size_t line_break = text.rfind('\n'); line_break != std::string_view::npos)
        return line_break + 1;
    std::size_t end = text.size() - 1;
    while (end > 1 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
    return end;
}

}  // namespace

Tokenizer::Tokenizer(TextSource source, unsigned threads)
    : source_(std::move(source)), threads_(source_.size > kChunkBytes ? std::max(threads, 1U) : 1) {
    for (unsigned i = 0; i < threads_; ++i) read_ahead({});
}

void Tokenizer::next_chunk() {
    lines_ += chunk_.lines;
    next_ = 0;
    Chunk used = std::exchange(chunk_, ahead_.front().get());
    ahead_.pop_front();
    read_ahead(std::move(used));
}

/// What it holds goes on in the next chunk; what it is used for again saves memory.
void Tokenizer::read_ahead(Chunk chunk) {
    if (ended_) return;
    fill(chunk);
    ended_ = chunk.last;
    const bool whole_lines = chunk.last || chunk.text[chunk.text.size() - 2] == '\n';
    if (!whole_lines) {
        // Only now is known where the next one begins.
        lex(chunk);
        ended_ = !chunk.fault.empty();
        const auto rest = chunk.text.begin() + static_cast<std::ptrdiff_t>(chunk.rest);
        offset_ -= static_cast<std::size_t>(chunk.text.end() - 1 - rest);
        carry_.insert(carry_.begin(), rest, chunk.text.end() - 1);
    }
    const auto launch = threads_ > 1 && whole_lines ? std::launch::async : std::launch::deferred;
    ahead_.push_back(std::async(
        launch,
        [whole_lines](Chunk read) {
            if (whole_lines) lex(read);
            return read;
        },
        std::move(chunk)));
}

/// The next stretch of the text, and the line break behind it that is none of the text's.
void Tokenizer::fill(Chunk& chunk) {
    const std::size_t size = std::min(kChunkBytes, source_.size - offset_);
    chunk.text.resize(size + 1);
    const auto fresh = std::copy(carry_.begin(), carry_.end(), chunk.text.begin());
    source_.read(&*fresh, size - carry_.size());
    chunk.offset = offset_;
    chunk.last = offset_ + size == source_.size;
    const std::size_t end = chunk.last ? size : end_of_chunk({chunk.text.data(), size});
    carry_.assign(chunk.text.begin() + static_cast<std::ptrdiff_t>(end), chunk.text.end() - 1);
    offset_ += end;
    chunk.text.resize(end + 1);
    chunk.text.back() = '\n';
}

void Tokenizer::fail_expected(std::string_view what) {
    const Token& token = peek();
    const std::string found = token.kind == Token::Kind::end_of_file ? "the end of the file"
                              : token.kind == Token::Kind::string    ? "\"" + excerpt(token.text()) + "\""
                                                                     : "'" + excerpt(token.text()) + "'";
    throw ParseError(line(), "expected " + std::string(what) + ", found " + found);
}

void Tokenizer::fail_outside(std::string_view what, double min, double max) {
    fail_expected(std::string(what) + " (a number from " + compact(min) + " to " + compact(max) + ")");
}

void Tokenizer::fail_outside(std::string_view what, std::int64_t min, std::int64_t max) {
    fail_expected(std::string(what) + " (an integer from " + std::to_string(min) + " to " +
                  std::to_string(max) + ")");
}

std::string_view Tokenizer::take_word(std::string_view what) {
    if (peek().kind != Token::Kind::word) fail_expected(what);
    return take().text();
}

std::string Tokenizer::take_string(std::string_view what) {
    if (peek().kind != Token::Kind::string) fail_expected(std::string(what) + " in quotes");
    const std::string_view text = take().text();
    std::string result;
    result.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) result += text[text[i] == '\\' ? ++i : i];
    return result;
}

bool Tokenizer::take_flag(std::string_view what) { return take_integer(what, 0, 1) != 0; }

std::size_t Tokenizer::take_count(std::string_view what, std::size_t bytes_each) {
    // A count is checked against the file before anything is allocated for it.
    const std::size_t at = line();
    const std::string_view text = peek().text();
    const auto end = chunk_.offset + static_cast<std::size_t>(text.data() + text.size() - chunk_.text.data());
    const auto count = static_cast<std::size_t>(take_integer(what, 0, std::int64_t{1} << 32));
    if (count > (source_.size - end) / bytes_each)
        throw ParseError(
            at, "expected " + std::string(what) + " that fits into the file, found " + excerpt(text));
    return count;
}

}  // namespace vrut::io

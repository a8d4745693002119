// Scene text of many chunks: what is read of it, what is refused, and how much memory that takes.
#include <doctest/doctest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <new>
#include <random>
#include <sstream>
#include <thread>

#include "io/vrut/text_reader.hpp"
#include "io/vrut/text_writer.hpp"

using namespace vrut;

// --- all that the program allocates is counted

namespace {

std::atomic<std::size_t> live_bytes{0}, peak_bytes{0};

void* counted(void* memory) {
    if (memory == nullptr) throw std::bad_alloc();
    const std::size_t live = live_bytes += malloc_usable_size(memory);
    for (std::size_t peak = peak_bytes; live > peak && !peak_bytes.compare_exchange_weak(peak, live);) {
    }
    return memory;
}

void uncounted(void* memory) {
    live_bytes -= malloc_usable_size(memory);
    std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return counted(std::malloc(std::max(size, std::size_t{1}))); }
void operator delete(void* memory) noexcept { uncounted(memory); }
void operator delete(void* memory, std::size_t) noexcept { uncounted(memory); }

namespace {

/// By how much the allocated memory rises meanwhile.
template <class Work>
std::size_t memory_of(const Work& work) {
    const std::size_t before = live_bytes;
    peak_bytes = before;
    work();
    return peak_bytes - before;
}

// --- texts

/// Of some megabytes, with everything in it that tells where tokens and lines end.
std::string large_text(int geometries, int vertices, const char* row_end = "\n") {
    std::mt19937 random(3);
    std::ostringstream text;
    text << "vrut-text 1\n";
    const auto rows = [&](const char* name, int count, int columns, const auto& number) {
        text << name << " " << count << row_end;
        for (int row = 0; row < count; ++row) {
            for (int column = 0; column < columns; ++column) text << " " << number();
            text << row_end;
        }
    };
    for (int id = 0; id < geometries; ++id) {
        text << "material " << id << " \"é \\\"# \\\\ " << std::string(random() % 40, 'x') << "🚗\" end"
             << row_end;
        text << "geometry " << id << row_end;
        rows("vertices", vertices, 3, [&] { return std::uniform_real_distribution<double>(-9, 9)(random); });
        rows("triangles", 2 * vertices, 3, [&] { return random() % static_cast<unsigned>(vertices); });
        text << "end" << row_end;
        text << "node " << id + 1 << " \"N\" geometry geometry " << id << " material " << id << " end"
             << row_end;
    }
    return text.str();
}

/// What a text is read as by so many threads: the same scene's text, or the sentence.
std::string outcome(std::string_view text, unsigned threads) {
    auto parts = io::read_vrut_parts(text, "large.vrut", {}, threads);
    if (!parts) return parts.error();
    auto scene = io::build_scene(*std::move(parts), "large.vrut");
    if (!scene) return scene.error();
    std::ostringstream out;
    io::write_vrut_text(*scene, out);
    return out.str();
}

std::string with(std::string text, std::size_t place, std::string_view inserted) {
    return text.insert(place, inserted);
}

class TemporaryFile {
public:
    TemporaryFile(const char* name, std::string_view text, std::uintmax_t size)
        : path_(std::filesystem::temp_directory_path() / name) {
        std::ofstream(path_, std::ios::binary) << text;
        std::filesystem::resize_file(path_, size);  // the rest takes no room
    }
    ~TemporaryFile() { std::filesystem::remove(path_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

constexpr std::size_t kMegabyte = 1 << 20;

}  // namespace

TEST_CASE("a large text is read as what it says, by however many threads and however it is laid out") {
    const std::string text = large_text(5, 4000);
    REQUIRE(text.size() > kMegabyte);
    const std::string once = outcome(text, 1);
    REQUIRE(once.starts_with("vrut-text 1\n"));
    CHECK(outcome(once, 1) == once);
    for (const unsigned threads : {2U, 7U}) CHECK(outcome(text, threads) == once);
    // All in one line; and with comments longer than what is read at a time.
    CHECK(outcome(large_text(5, 4000, " "), 3) == once);
    for (const std::size_t shift : {0U, 1U, 2U, 3U, 5U, 8U}) {
        CAPTURE(shift);
        CHECK(outcome("vrut-text 1" + std::string(shift, ' ') + large_text(5, 4000, " ").substr(11), 3) ==
              once);
        std::string comment = "#" + std::string(shift, '-');
        for (int i = 0; i < 300'000; ++i) comment += "é";
        const std::size_t middle = text.find('\n', text.size() / 3);
        CHECK(outcome(with(with(text, middle, "\n" + comment + " end \""), 11, comment), 3) == once);
    }
}

TEST_CASE("the first fault of a large text is told with its line, by however many threads") {
    const std::string text = large_text(4, 3000);
    std::mt19937 random(5);
    const auto line_of = [&](std::size_t place) {
        return 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n');
    };
    for (int round = 0; round < 40; ++round) {
        // Behind a line break, so that the fault is no part of another token.
        std::size_t first = text.find('\n', random() % (text.size() / 2)) + 1;
        const std::size_t second = text.find('\n', first + random() % 1000) + 1;
        constexpr const char* kFaults[] = {"1e999 ", "\"\\n\" ", "\xFF ", "1.2.3 ", "\"x\n", "0x10 "};
        const char* const fault = kFaults[static_cast<std::size_t>(round) % std::size(kFaults)];
        const std::string bad = with(with(text, second, "1e999 "), first, fault);
        const std::string sentence = outcome(bad, 1);
        CAPTURE(fault);
        CHECK_MESSAGE(sentence.starts_with("large.vrut:" + std::to_string(line_of(first)) + ": expected "),
                      sentence);
        CHECK(outcome(bad, 2) == sentence);
        CHECK(outcome(bad, 7) == sentence);
    }
}

TEST_CASE("a string, a word, a number of a gigabyte is refused at once, and takes no memory") {
    constexpr std::uintmax_t kGigabyte = 1 << 30;
    for (const std::string start : {"\"", "x", "1", "\"x \\\\"}) {
        CAPTURE(start);
        const TemporaryFile file("vrut-preview-gigabyte.vrut", "vrut-text 1\nmaterial 1\n" + start,
                                 kGigabyte);
        io::PartsResult result;
        CHECK(memory_of([&] { result = io::read_vrut_file(file.path()); }) < 20 * kMegabyte);
        REQUIRE_FALSE(result);
        CHECK_MESSAGE(result.error().starts_with(file.path().string() + ":3: expected "), result.error());
    }
}

TEST_CASE("a file that is cut short while it is read gives a sentence") {
    const std::string text = large_text(4, 10'000);
    const TemporaryFile file("vrut-preview-cut.vrut", text, text.size());
    const auto result =
        io::read_vrut_file(file.path(), [&](double) { std::filesystem::resize_file(file.path(), 1000); });
    REQUIRE_FALSE(result);
    CHECK(result.error() == file.path().string() + ": it cannot be read to its end");
}

TEST_CASE("progress is told on the way, by the thread that reads") {
    std::vector<double> told;
    const auto reader = std::this_thread::get_id();
    const std::string text = large_text(1, 20'000);
    CHECK(io::read_vrut_text(text, "large.vrut", [&](double part) {
        CHECK(std::this_thread::get_id() == reader);
        told.push_back(part);
    }));
    CHECK(told.size() > 4);
    CHECK(std::is_sorted(told.begin(), told.end()));
    CHECK(told.front() == 0);
    CHECK(told.back() < 1);
}

TEST_CASE("a comment of 64 MB is skipped, and takes no memory") {
    const TemporaryFile file("vrut-preview-comment.vrut", "vrut-text 1 # no end", 64 * kMegabyte);
    io::PartsResult result;
    CHECK(memory_of([&] { result = io::read_vrut_file(file.path()); }) < 20 * kMegabyte);
    CHECK_MESSAGE(result, result.error());
}

TEST_CASE("memory stays within its multiple of the text, whatever that says") {
    const auto times = [](const std::string& piece, std::size_t bytes, const char* end = "") {
        std::string text = "vrut-text 1\n";
        for (std::size_t id = 0; text.size() < bytes; ++id)
            text += std::string(piece).replace(piece.find('@'), 1, std::to_string(id + 1));
        return text + end;
    };
    std::string claims = "vrut-text 1\ngeometry 1\nvertices " + std::to_string(kMegabyte / 6);
    claims.resize(kMegabyte + 100, ' ');
    const std::string texts[] = {
        times("node @\"\"0 end\n", kMegabyte / 4),
        times("node @\"\"3 end\n", kMegabyte / 4),
        times("material @\"\"end\n", kMegabyte / 4),
        times("geometry @ end\n", kMegabyte / 4),
        times("node @\"\"7 cube-map\"\"\"\"\"\"\"\"\"\"\"\"end\n", kMegabyte / 4),
        times("node @\"\"5 ranges 0 0 0 0 0 0 0 0 0 end\n", kMegabyte / 4),
        times("node @\"\"0 x end\n", kMegabyte / 4),
        times("geometry @ vertices 9 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 end\n",
              kMegabyte / 4),
        claims,
        large_text(3, 20'000),
    };
    for (const std::string& text : texts) {
        CAPTURE(text.substr(0, 60));
        const std::size_t peak =
            memory_of([&] { static_cast<void>(io::read_vrut_text(text, "large.vrut")); });
        CHECK(peak < 100 * text.size() + 4 * kMegabyte);
    }
}

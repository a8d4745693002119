// Samples are averaged on the CPU or on the GPU: the images are equal to the bit.
#include <array>
#include <limits>

#include "plan/frame_plan.hpp"
#include "planes.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

using renderer::ResolveOn;
using Output = plan::RenderJob::Output;

/// Many layers of glass before a sphere: the target has 16 bits a channel.
std::shared_ptr<const scene::PlacedScene> sphere_behind_glass(int panes) {
    std::vector<Part> parts{{1, sphere(1, 12), material_of({0.7, 0.5, 0.3}), glm::dmat4(1)}};
    for (int i = 0; i < panes; ++i) {
        scene::Material glass = material_of({0.2, 0.9, 0.1 * i});
        glass.diffuse.a = 0.1;
        glass.two_sided = true;
        parts.push_back({2 + i, quad(2), glass, moved_by({0, 0, 1.5 + 0.1 * i})});
    }
    return scene_of(parts);
}

plan::View view_of(int panes, const glm::ivec2& size) {
    plan::View view = view_from({0.3, 0.6, 5});
    view.scene = sphere_behind_glass(panes);
    view.width = size.x;
    view.height = size.y;
    return view;
}

scene::Image draw(renderer::Renderer& renderer, const plan::View& view) {
    scene::Image image;
    plan::FrameStats stats;
    renderer.render(view, image, stats);
    return image;
}

}  // namespace

TEST_CASE("both resolvers give the same image, whatever its size, samples and glass") {
    RendererFixture studio;
    for (const int panes : {0, 9})
        for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(33, 17), glm::ivec2(160, 120)}) {
            plan::View view = view_of(panes, size);
            for (const int samples : {1, 3, 16}) {
                CAPTURE(panes);
                CAPTURE(size.x);
                CAPTURE(samples);
                view.samples = samples;
                studio.renderer().use_resolver(ResolveOn::cpu);
                const scene::Image expected = draw(studio.renderer(), view);
                studio.renderer().use_resolver(ResolveOn::gpu);
                CHECK(draw(studio.renderer(), view).rgba == expected.rgba);
            }
        }
}

TEST_CASE("on the GPU an image goes on to more samples, and is read once for each number of them") {
    RendererFixture studio;
    plan::View view = view_of(3, {160, 120});
    std::vector<scene::Image> expected;
    for (const int samples : {1, 4, 16}) {
        view.samples = samples;
        expected.push_back(draw(studio.renderer(), view));
    }
    studio.renderer().use_resolver(ResolveOn::gpu);
    view.samples = 1;
    plan::RenderJob job(view, {}, plan::RenderJob::Keep::samples);
    for (const auto& [samples, image] : {std::pair(1, 0U), {1, 0U}, {4, 1U}, {16, 2U}}) {
        CAPTURE(samples);
        const int before = job.samples;
        if (before > 0) job.refine(samples, {});
        while (!studio.renderer().step(job)) {
        }
        CHECK(job.stats.samples == samples - before);
        CHECK(job.stats.readbacks == 1);
        CHECK(job.image.rgba == expected[image].rgba);
        job.image = {};  // handed on
    }
}

TEST_CASE("on the GPU an image becomes the planes that the JPEG encoder takes") {
    RendererFixture studio;
    studio.renderer().use_resolver(ResolveOn::gpu);
    for (const int panes : {0, 5})
        for (const glm::ivec2 size :
             {glm::ivec2(1, 1), glm::ivec2(33, 17), glm::ivec2(46, 32), glm::ivec2(160, 121)})
            for (const bool subsampled : {false, true}) {
                CAPTURE(size.x);
                CAPTURE(subsampled);
                plan::View view = view_of(panes, size);
                view.samples = panes + 1;
                const scene::PlanarImage expected = planes_of(draw(studio.renderer(), view), subsampled);
                plan::RenderJob job(view);
                job.output = subsampled ? Output::ycbcr_420 : Output::ycbcr_444;
                while (!studio.renderer().step(job)) {
                }
                CHECK(job.planes.width == size.x);
                CHECK(job.planes.height == size.y);
                CHECK(job.planes.subsampled == subsampled);
                CHECK(job.planes.bytes == expected.bytes);
            }
}

TEST_CASE("on the GPU images that are drawn in turns, or given up, do not touch each other") {
    RendererFixture studio;
    std::vector<plan::View> views;
    std::vector<scene::Image> expected;
    for (const int i : {0, 1, 2, 3}) {
        plan::View view = view_of(i, {60 + 10 * i, 40});
        view.samples = 1 + i;
        views.push_back(view);
        expected.push_back(draw(studio.renderer(), view));
    }
    studio.renderer().use_resolver(ResolveOn::gpu);
    for (int round = 0; round < 3; ++round) {
        std::vector<plan::RenderJob> jobs;
        for (const plan::View& view : views) jobs.emplace_back(view);
        if (round > 0)  // given up after some steps
            for (int step = 0; step < round; ++step)
                for (const plan::View& view : views) {
                    plan::RenderJob job(view);
                    studio.renderer().step(job);
                }
        std::array<bool, 4> whole{};
        while (std::ranges::find(whole, false) != whole.end())
            for (std::size_t i = 0; i < jobs.size(); ++i)
                if (!whole[i]) whole[i] = studio.renderer().step(jobs[i]);
        for (std::size_t i = 0; i < jobs.size(); ++i) CHECK(jobs[i].image.rgba == expected[i].rgba);
    }
}

TEST_CASE("an image whose samples another resolver has is drawn from its first sample on") {
    RendererFixture studio;
    plan::View view = view_of(2, {160, 120});
    view.samples = 4;
    const scene::Image expected = draw(studio.renderer(), view);
    for (const ResolveOn first : {ResolveOn::cpu, ResolveOn::gpu}) {
        studio.renderer().use_resolver(first);
        plan::RenderJob job(view);
        while (job.samples < 2) studio.renderer().step(job);
        studio.renderer().use_resolver(first == ResolveOn::cpu ? ResolveOn::gpu : ResolveOn::cpu);
        while (!studio.renderer().step(job)) {
        }
        CHECK(job.image.rgba == expected.rgba);
        CHECK(job.stats.samples == 6);
    }
}

TEST_CASE("which resolver is used is measured, and changes no image") {
    RendererFixture studio;
    plan::View view = view_of(2, {160, 120});
    view.samples = 4;
    const scene::Image expected = draw(studio.renderer(), view);
    const renderer::ResolverTimes times = studio.renderer().choose_resolver();
    CHECK(times.cpu_ms > 0);
    CHECK(times.gpu_ms > 0);
    MESSAGE("640x360: " << times.cpu_ms << " ms on the CPU, " << times.gpu_ms << " ms on the GPU");
    CHECK(draw(studio.renderer(), view).rgba == expected.rgba);
    plan::RenderJob job(view);
    while (!studio.renderer().step(job)) {
    }
    CHECK(job.stats.readbacks == (times.faster() == ResolveOn::gpu ? 1 : 4));
    CHECK(renderer::ResolverTimes{2, 1}.faster() == ResolveOn::gpu);
    CHECK(renderer::ResolverTimes{1, std::numeric_limits<double>::infinity()}.faster() == ResolveOn::cpu);
}

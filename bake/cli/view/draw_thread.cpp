#include "bake/cli/view/draw_thread.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "bake/cli/messages.h"
#include "bake/lights/builtin_environment.h"

namespace opaline::cli {
namespace {

constexpr std::uint32_t kFinalSamples = 3;  // along a pixel's side, as `render`
constexpr double kQuick = 0.04;             // seconds of a picture in motion
constexpr double kSoon = 0.5;               // seconds that one waits for the last picture
constexpr std::chrono::milliseconds kRest{120};

// A file that is open, and which reading of which path it is.
struct OpenFile {
    std::string path;
    std::uint64_t version = 0;
    std::unique_ptr<ShownFile> shown;
};

// Opens it unless it is. Where that fails, what was open stays, and is tried again the next time.
formats::Status keep_open(OpenFile& file, const std::string& path, std::uint64_t version) {
    if (path.empty()) {
        file = {};
        return formats::ok_status();
    }
    if (file.shown && file.path == path && file.version == version) return formats::ok_status();
    auto opened = ShownFile::open(path);
    if (!opened) return opened.error();
    file.path = path;
    file.version = version;
    file.shown = std::move(*opened);
    return formats::ok_status();
}

// A picture's size is divided by `divisor`.
struct PassQuality {
    std::uint32_t divisor = 1, supersampling = kFinalSamples;

    double samples(const ViewState& state) const {
        const double pixels = static_cast<double>(state.width) * state.height;
        return pixels * supersampling * supersampling / (divisor * divisor);
    }
};
constexpr std::array<PassQuality, 4> kPassQualities{{{4, 1}, {2, 1}, {1, 1}, {1, kFinalSamples}}};

// The best that takes kQuick; the coarsest before any picture was timed.
std::size_t quick_quality(const ViewState& state, double seconds_per_sample) {
    std::size_t best = 0;
    while (best + 1 < kPassQualities.size() &&
           kPassQualities[best + 1].samples(state) * seconds_per_sample <= kQuick) {
        ++best;
    }
    return best;
}

// The one after another; the last where that takes kSoon.
std::size_t next_quality(std::size_t quality, const ViewState& state, double seconds_per_sample) {
    const bool is_soon = kPassQualities.back().samples(state) * seconds_per_sample <= kSoon;
    return is_soon ? kPassQualities.size() - 1 : quality + 1;
}

struct DrawWork {
    OpenFile file, other;
    std::string light;
    std::uint64_t light_request = 0, light_version = 0;
    std::optional<formats::Environment> environment;
    double seconds_per_sample = HUGE_VAL;  // of the last picture

    formats::Status open_all(const DrawRequest& request);
    formats::Result<DrawnView> draw(const DrawRequest& request, const PassQuality& quality,
                                    const std::atomic<bool>& stop);
    formats::Result<DrawnSide> draw_side(OpenFile& from, const DrawRequest& request,
                                         const runtime::Camera& camera, std::uint32_t samples,
                                         const std::atomic<bool>& stop);
};

formats::Status DrawWork::open_all(const DrawRequest& request) {
    if (auto status = keep_open(file, request.state.file, request.version.file); !status) {
        return status;
    }
    if (auto status = keep_open(other, request.state.other, request.version.other); !status) {
        return status;
    }
    if (environment && light == request.state.light && light_request == request.version.light) {
        return formats::ok_status();
    }
    auto opened = bake::open_environment(request.state.light);
    if (!opened) return opened.error();
    if (auto status = report_warnings(opened->warnings); !status) return status;
    environment = std::move(opened->environment);
    light = request.state.light;
    light_request = request.version.light;
    ++light_version;
    return formats::ok_status();
}

formats::Result<DrawnSide> DrawWork::draw_side(OpenFile& from, const DrawRequest& request,
                                               const runtime::Camera& camera, std::uint32_t samples,
                                               const std::atomic<bool>& stop) {
    DrawnSide side;
    if (!from.shown) return side;
    ShownFile& shown = *from.shown;
    const auto sampling =
        samples == kFinalSamples ? runtime::MapSampling::full : runtime::MapSampling::moving;
    if (auto status = shown.follow(request.state, *environment, light_version, sampling); !status) {
        return status.error();
    }
    auto picture = shown.draw(camera, samples, request.is_exact && samples == kFinalSamples, stop);
    if (!picture) return picture.error();
    side.picture = std::move(*picture);
    side.facts = shown.facts();
    side.seconds = shown.seconds();
    side.coefficient_error = shown.coefficient_error();
    return side;
}

formats::Result<DrawnView> DrawWork::draw(const DrawRequest& request, const PassQuality& quality,
                                          const std::atomic<bool>& stop) {
    if (auto status = open_all(request); !status) return status.error();
    const ViewState& state = request.state;
    const Viewpoint from = state.viewpoint ? *state.viewpoint : file.shown->framing(state);
    runtime::Camera camera = camera_of(state, from);
    camera.width = std::max(1u, camera.width / quality.divisor);
    camera.height = std::max(1u, camera.height / quality.divisor);
    DrawnView view;
    view.viewpoint = from;
    view.is_final = quality.divisor == 1 && quality.supersampling == kFinalSamples;
    auto first = draw_side(file, request, camera, quality.supersampling, stop);
    if (!first) return first.error();
    view.file = std::move(*first);
    const auto exposure = file.shown->choose_exposure(camera_of(state, from));
    if (!exposure) return exposure.error();
    view.exposure = *exposure;
    auto second = draw_side(other, request, camera, quality.supersampling, stop);
    if (!second) return second.error();
    view.other = std::move(*second);
    const double seconds = view.file.seconds.draw + view.file.seconds.readback +
                           view.other.seconds.draw + view.other.seconds.readback;
    seconds_per_sample = seconds / quality.samples(state);
    return view;
}

// How often it changed since the last look; `path` empty: there is none.
std::uint64_t changes_of(std::optional<FileWatch>& watch, const std::string& path) {
    if (path.empty()) {
        watch.reset();
        return 0;
    }
    if (!watch || watch->path() != path) watch.emplace(path);
    return watch->look() ? 1 : 0;
}

}  // namespace

DrawThread::DrawThread() : thread_([this] { run(); }) {}

DrawThread::~DrawThread() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        stop_ = true;
    }
    wake_.notify_all();
    thread_.join();
}

void DrawThread::request(DrawRequest request) {
    {
        const std::lock_guard lock(mutex_);
        request_ = std::move(request);
        stop_ = true;
    }
    wake_.notify_all();
}

std::shared_ptr<const DrawnView> DrawThread::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(drawn_, nullptr);
}

void DrawThread::run() {
    DrawWork work;
    // Whether it was given up for another request.
    const auto draw = [&](const DrawRequest& request, std::size_t quality) {
        auto drawn = std::make_shared<DrawnView>();
        try {
            auto view = work.draw(request, kPassQualities[quality], stop_);
            if (view) {
                *drawn = std::move(*view);
            } else {
                drawn->error = view.error();
            }
        } catch (const std::exception& fault) {
            drawn->error = formats::make_error(formats::ErrorKind::resource, "", "drawing",
                                               fault.what(), "close other programs");
        }
        if (drawn->error && drawn->error->kind == formats::ErrorKind::interrupted) return false;
        drawn->serial = request.serial;
        const bool goes_on = !drawn->error && !drawn->is_final;
        const std::lock_guard lock(mutex_);
        drawn_ = std::move(drawn);
        return goes_on;
    };
    for (;;) {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [this] { return ends_ || request_; });
        if (ends_) return;
        const DrawRequest request = *std::exchange(request_, std::nullopt);
        stop_ = false;
        lock.unlock();
        std::size_t quality = quick_quality(request.state, work.seconds_per_sample);
        while (draw(request, quality)) {
            lock.lock();
            if (wake_.wait_for(lock, kRest, [this] { return ends_ || request_; })) break;
            lock.unlock();
            quality = next_quality(quality, request.state, work.seconds_per_sample);
        }
    }
}

std::size_t WatchedFiles::look(const ViewState& state) {
    constexpr std::chrono::milliseconds kPause{200};
    const auto now = std::chrono::steady_clock::now();
    if (now - last_look_ < kPause) return 0;
    last_look_ = now;
    const std::uint64_t file = changes_of(file_, state.file);
    const std::uint64_t other = changes_of(other_, state.other);
    const std::uint64_t light =
        changes_of(light_, bake::is_builtin(state.light) ? std::string() : state.light);
    versions_ = {versions_.file + file, versions_.other + other, versions_.light + light};
    return file + other + light;
}

}  // namespace opaline::cli

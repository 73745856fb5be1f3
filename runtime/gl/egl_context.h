#pragma once

#include <string>

#include "formats/opal/result.h"

namespace opaline::runtime {

/// An OpenGL 4.5 core context without a window. EGL's types are pointers; they stay out of here.
class EglContext {
  public:
    /// The first that works of: GPUs that EGL lists as devices, Mesa's surfaceless platform,
    /// software devices, EGL's default display. Errors: resource, saying what was tried.
    static formats::Result<EglContext> create();

    EglContext(EglContext&& other) noexcept;
    EglContext& operator=(EglContext&& other) noexcept;
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;
    ~EglContext();

    /// A function of OpenGL, or nullptr.
    static void* load_function(const char* name);

    /// GL renderer and version, for messages and statistics.
    const std::string& description() const { return description_; }

  private:
    friend class CurrentContext;
    EglContext() = default;
    void* display_ = nullptr;
    void* context_ = nullptr;
    std::string description_;
};

/// Makes a context current on this thread for as long as it lives, then restores the previous one.
class CurrentContext {
  public:
    explicit CurrentContext(const EglContext& context);
    CurrentContext(const CurrentContext&) = delete;
    CurrentContext& operator=(const CurrentContext&) = delete;
    ~CurrentContext();

    /// ok, or resource: another thread holds the context, or the driver lost it.
    formats::Status status() const;

  private:
    void *own_display_ = nullptr, *display_ = nullptr, *context_ = nullptr, *draw_ = nullptr,
         *read_ = nullptr;
    unsigned api_ = 0;
    bool is_current_ = false;
};

}  // namespace opaline::runtime

#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace opaline::formats {

/// One thing to tell the user about their data.
/// Printed as `opaline: error: FILE: WHERE: FAULT (REMEDY)`; empty parts are left out.
struct Diagnostic {
    enum class Severity { warning, error } severity = Severity::error;
    std::string file;    ///< as the user typed it
    std::string where;   ///< "node 'Vase' > mesh 3 > primitive 0"
    std::string fault;   ///< what was found, and what was expected
    std::string remedy;  ///< one thing to do next
};

/// Why a job could not be done; decides the exit code of the command line (design: exit codes).
enum class ErrorKind { usage, bad_input, newer_file, resource, interrupted };

/// A failed operation: its kind and everything worth saying, the first entry being the main fault.
struct Error {
    ErrorKind kind = ErrorKind::bad_input;
    std::vector<Diagnostic> diagnostics;
};

/// Error with one diagnostic.
inline Error make_error(ErrorKind kind, std::string file, std::string where, std::string fault,
                        std::string remedy = {}) {
    return {kind,
            {{Diagnostic::Severity::error, std::move(file), std::move(where), std::move(fault),
              std::move(remedy)}}};
}

inline Diagnostic make_warning(std::string file, std::string where, std::string fault,
                               std::string remedy = {}) {
    return {Diagnostic::Severity::warning, std::move(file), std::move(where), std::move(fault),
            std::move(remedy)};
}

/// A value or the reason why there is none. (`std::expected` as g++ 12 lacks it in C++20.)
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    bool has_value() const { return state_.index() == 0; }
    explicit operator bool() const { return has_value(); }

    /// Precondition: has_value().
    T& value() & { return *std::get_if<0>(&state_); }
    const T& value() const& { return *std::get_if<0>(&state_); }
    T&& value() && { return std::move(*std::get_if<0>(&state_)); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    /// Precondition: !has_value().
    Error& error() & { return *std::get_if<1>(&state_); }
    const Error& error() const& { return *std::get_if<1>(&state_); }
    Error&& error() && { return std::move(*std::get_if<1>(&state_)); }

  private:
    std::variant<T, Error> state_;
};

/// For operations that return nothing but may fail.
using Status = Result<std::monostate>;
inline Status ok_status() {
    return Status(std::monostate{});
}

}  // namespace opaline::formats

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace opaline::bake {

/// Rows of floats, each in 16 bits times a scale of its row: off by at most 1.6e-5 of the row's
/// largest value. Sums of many rows wait for memory, so half of the bytes are half of the time.
class CodedRows {
  public:
    CodedRows() = default;
    /// `count` rows of `size` zeros.
    CodedRows(std::size_t count, std::size_t size)
        : code_(count * size), scale_(count), size_(size) {}

    /// `values`: rows of `size`, one after the other.
    CodedRows(std::span<const float> values, std::size_t size)
        : CodedRows(values.size() / size, size) {
        for (std::size_t i = 0; i < count(); ++i) {
            set(i, values.subspan(i * size, size));
        }
    }

    /// `count` rows, new ones of zeros.
    void resize(std::size_t count) {
        code_.resize(count * size_);
        scale_.resize(count);
    }
    /// `row`: of size() finite values. Different rows may be set at the same time.
    void set(std::size_t i, std::span<const float> row);
    /// to += weight * row i.
    void add(std::size_t i, float weight, std::span<float> to) const;
    /// The same of the values from `first` on.
    void add_part(std::size_t i, std::size_t first, float weight, std::span<float> to) const;
    std::vector<float> row(std::size_t i) const;
    float value(std::size_t i, std::size_t k) const {
        return scale_[i] * static_cast<float>(code_[i * size_ + k]);
    }

    std::size_t size() const { return size_; }
    std::size_t count() const { return scale_.size(); }

  private:
    std::vector<std::int16_t> code_;
    std::vector<float> scale_;
    std::size_t size_ = 0;
};

}  // namespace opaline::bake

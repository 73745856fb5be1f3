#pragma once

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

namespace opaline::tests {

/// Evaluates "1+i+2*j+i*j" and the like: + - * / ^, brackets, numbers, named variables, and the
/// functions sin, cos, exp, sqrt, abs. Throws std::invalid_argument on anything else.
class Expression {
  public:
    Expression(std::string text, std::map<std::string, double> variables)
        : text_(std::move(text)), variables_(std::move(variables)) {}

    double evaluate() {
        at_ = 0;
        const double value = sum();
        if (at_ != text_.size()) {
            throw std::invalid_argument("cannot read '" + text_.substr(at_) + "'");
        }
        return value;
    }

  private:
    bool accept(char c) {
        if (at_ < text_.size() && text_[at_] == c) {
            ++at_;
            return true;
        }
        return false;
    }
    double sum() {
        double value = product();
        while (true) {
            if (accept('+')) {
                value += product();
            } else if (accept('-')) {
                value -= product();
            } else {
                return value;
            }
        }
    }
    double product() {
        double value = power();
        while (true) {
            if (accept('*')) {
                value *= power();
            } else if (accept('/')) {
                value /= power();
            } else {
                return value;
            }
        }
    }
    double power() {
        const double base = atom();
        return accept('^') ? std::pow(base, power()) : base;
    }
    double atom() {
        if (accept('-')) return -power();
        if (accept('(')) {
            const double value = sum();
            if (!accept(')')) {
                throw std::invalid_argument("missing )");
            }
            return value;
        }
        std::string name;
        while (at_ < text_.size() && std::isalpha(static_cast<unsigned char>(text_[at_])) != 0) {
            name += text_[at_++];
        }
        if (name.empty()) {
            std::size_t used = 0;
            const double value = std::stod(text_.substr(at_), &used);
            at_ += used;
            return value;
        }
        if (const auto it = variables_.find(name); it != variables_.end()) return it->second;
        const double x = atom();
        if (name == "sin") return std::sin(x);
        if (name == "cos") return std::cos(x);
        if (name == "exp") return std::exp(x);
        if (name == "sqrt") return std::sqrt(x);
        if (name == "abs") return std::abs(x);
        throw std::invalid_argument("unknown name " + name);
    }

    std::string text_;
    std::map<std::string, double> variables_;
    std::size_t at_ = 0;
};

}  // namespace opaline::tests

// Converts numbers with a fraction to text and back, as libcxx14.hpp declares.
#include <fast_float/fast_float.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace std {

static double read(const char* text, double) { return strtod(text, nullptr); }
static float read(const char* text, float) { return strtof(text, nullptr); }

static to_chars_result put(char* first, char* last, const char* text) {
  const size_t size = strlen(text);
  if (last - first < static_cast<ptrdiff_t>(size)) return {last, errc::value_too_large};
  memcpy(first, text, size);
  return {first + size, errc{}};
}

// The shortest digits that read as the value; with or without exponent, whichever is shorter.
template <class T>
static to_chars_result shortest(char* first, char* last, T value) {
  char digits[40];
  int precision = 0;
  do {
    snprintf(digits, sizeof digits, "%.*e", precision, static_cast<double>(value));
  } while (isfinite(value) && read(digits, value) != value && ++precision < 17);
  if (!isfinite(value)) return put(first, last, digits);
  char fixed[400];
  const int exponent = atoi(strchr(digits, 'e') + 1);
  snprintf(fixed, sizeof fixed, "%.*f", max(0, precision - exponent), static_cast<double>(value));
  return put(first, last, strlen(fixed) <= strlen(digits) ? fixed : digits);
}

to_chars_result to_chars(char* first, char* last, double value) {
  return shortest(first, last, value);
}
to_chars_result to_chars(char* first, char* last, float value) {
  return shortest(first, last, value);
}
to_chars_result to_chars(char* first, char* last, double value, chars_format, int digits) {
  char text[40];
  snprintf(text, sizeof text, "%.*g", digits, value);
  return put(first, last, text);
}

from_chars_result from_chars(const char* first, const char* last, double& value) {
  const auto [end, error] = fast_float::from_chars(first, last, value);
  return {end, error};
}

from_chars_result from_chars(const char* first, const char* last, float& value) {
  const auto [end, error] = fast_float::from_chars(first, last, value);
  return {end, error};
}

}  // namespace std

// LLVM 16 calls the program's main(int, char**) so; emscripten 3.1.6 looks for the name of C.
extern "C" int __main_argc_argv(int, char**);
int entry(int, char**) asm("main");
int entry(int argc, char** argv) { return __main_argc_argv(argc, argv); }

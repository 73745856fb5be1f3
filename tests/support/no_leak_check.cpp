// For programs that draw with OpenGL: while the leak check of the address sanitizer looks at all threads, those of Mesa's
// driver end, and once in some hundred runs it crashes over that. Drivers also keep memory until the process ends.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
    return "detect_leaks=0";
}
#endif
#endif

// For programs that are run with the real renderer under the sanitizers. EGL unloads its driver
// (Mesa's swrast_dri.so) when the last display ends, and what the driver's globals held is then counted as
// leaked, by "unknown module", which no suppression can name. While it stays loaded nothing is, and no leak
// needs to be suppressed.
#ifdef VRUT_SANITIZED
extern "C" int dlclose(void*) { return 0; }
#endif

/* Wine 8 lacks this library, from which Rust's standard library takes random numbers on Windows. Used only to test the
 * Windows program under such a Wine; Windows has its own. */
#include <windows.h>
#include <ntsecapi.h>

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE data, SIZE_T length) {
    return RtlGenRandom(data, (ULONG) length);
}

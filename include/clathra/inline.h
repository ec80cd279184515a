/* inline: functions that loops over arrays take in whole, so that they stay vector code and numbers that nobody reads
   cost nothing; a vector register of the machine. */
#pragma once

#define INLINE static inline __attribute__((always_inline))

/* Before a loop of which no pass reads what another writes: vector code that does not look whether arrays overlap.
   Clang has a word for it that warns where its code is none, so it looks. */
#if defined(__clang__)
  #define INDEPENDENT
#else
  #define INDEPENDENT _Pragma("GCC ivdep")
#endif

/* Numbers that are moved together are as many: of wider vectors the compiler keeps what it sums in memory. */
#if defined(__AVX512F__)
  #define CL_REGISTER 8
#elif defined(__AVX__)
  #define CL_REGISTER 4
#else
  #define CL_REGISTER 2
#endif
typedef double Register __attribute__((vector_size(CL_REGISTER * sizeof(double)), may_alias, aligned(sizeof(double))));

/* inline: functions that loops over arrays take in whole, so that they stay vector code and numbers that nobody reads
   cost nothing. */
#pragma once

#define INLINE static inline __attribute__((always_inline))

/* The modules through their C interface on a Cortex-M4F, all in one program. Prints what `src/main.rs` prints of them. */
#include "board.h"

#include "arm3_xi2.h"
#include "arm3_adaptive.h"
#include "puma560_one_percent.h"
#include "panda_exact.h"

/* Without a C library there is no <math.h>. */
#define NAN __builtin_nanf("")
#define INFINITY __builtin_inff()

/* States that are measured. */
#define STATES 1000

/* What stands for a control step where the stack of all else is measured. */
static void nothing_to_do(void *argument)
{
    (void)argument;
}

#define MODULE arm3_xi2
#define UPPER ARM3_XI2
#define ERROR 0.2f
#include "module.h"

#define MODULE arm3_adaptive
#define UPPER ARM3_ADAPTIVE
#define ERROR 0.2f
#include "module.h"

#define MODULE puma560_one_percent
#define UPPER PUMA560_ONE_PERCENT
#define ERROR 2.0f
#include "module.h"

#define MODULE panda_exact
#define UPPER PANDA_EXACT
#define ERROR 0.05f
#include "module.h"

int main(void)
{
    arm3_xi2_measure();
    arm3_adaptive_measure();
    puma560_one_percent_measure();
    panda_exact_measure();
    return 0;
}

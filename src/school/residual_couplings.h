/* residual_couplings.h: which fish the Jacobian couples: those whose outlines are near each other, and those in
 * contact. doc/numerics.md, section 6. Tested by tests/school/test_residual.c. */
#ifndef RESIDUAL_COUPLINGS_H
#define RESIDUAL_COUPLINGS_H

#include "base/status.h"
#include "contact/contact.h"
#include "contact/neighbours.h"
#include "fish/fish.h"

struct residual_couplings {
    const struct school *school;
    struct neighbours *neighbours; /* workspace of the residual                         (n_fish) */
    unsigned pattern;              /* changes whenever coupled does */
    double reach;                  /* fish couple whose outlines are no further apart, m */
    int couples_most;              /* no memory for more */
    unsigned char *coupled; /* whether the Jacobian holds the block of fish g in the rows of fish f (n_fish, n_fish) */
};

/* Nobody couples yet. The neighbours must outlive the couplings. Fails with STATUS_MEMORY; residual_couplings_free
 * releases what a failure leaves, too. */
enum status residual_couplings_fill(struct residual_couplings *couplings, const struct school *school,
                                    struct neighbours *neighbours);
void residual_couplings_free(struct residual_couplings *couplings);

/* Decide which fish couple, from the positions in y. Fails with STATUS_MEMORY; then they are those that were. */
enum status residual_couple(struct residual_couplings *couplings, const double *y);

/* Couple fish that are further apart than so far, from the positions in y and from now on: twice as far, and again,
 * until there are more. Returns whether there are; not beyond 400 MB of blocks, or without memory. */
int residual_couple_more(struct residual_couplings *couplings, const double *y);

/* Couple fish in contact too, however far apart the others are; returns whether there are any. */
int residual_couple_contacts(struct residual_couplings *couplings, const struct contact *contact);

#endif

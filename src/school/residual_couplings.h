/* residual_couplings.h: pairs of fish with a coupling block in the Jacobian: outlines closer than the reach, or in
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
    unsigned pattern;              /* changes with every change of coupled */
    double reach;                  /* fish couple if the distance of the outlines is at most this, m */
    int couples_most;              /* memory limit reached */
    unsigned char *coupled; /* whether the Jacobian holds the block of fish g in the rows of fish f (n_fish, n_fish) */
};

/* Fill *couplings without coupled pairs. The neighbours must outlive the couplings. Fails with STATUS_MEMORY; call
 * residual_couplings_free also after a failure. */
enum status residual_couplings_fill(struct residual_couplings *couplings, const struct school *school,
                                    struct neighbours *neighbours);
void residual_couplings_free(struct residual_couplings *couplings);

/* Couple fish by the positions in y. Fails with STATUS_MEMORY; the coupled pairs are then unchanged. */
enum status residual_couple(struct residual_couplings *couplings, const double *y);

/* Double the reach until more fish couple at the positions in y; the new reach is kept. Returns whether more fish
 * couple: 0 if the blocks would exceed 400 MB, or without memory. */
int residual_couple_more(struct residual_couplings *couplings, const double *y);

/* Couple all fish in contact, for any reach; returns whether any fish are in contact. */
int residual_couple_contacts(struct residual_couplings *couplings, const struct contact *contact);

#endif

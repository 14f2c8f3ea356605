// read_is_one_moment: From the second cycle of a read on, nothing that is held follows the results, until the read has ended.
reg f_reading; initial f_reading = 1'b0;
always @(posedge clock) f_reading <= reading & !reset;
always @* read_is_one_moment: assert (!f_reading | (!load & !show));

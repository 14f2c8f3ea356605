// read_is_one_snapshot: From the second cycle of a read on, no held word changes until the read has ended.
// moves_on: If two results of a channel have come since the held words were loaded, the next read loads them, whatever other channels owe.
reg [1:0] f_came; initial f_came = 2'd0;
always @(posedge clock) begin
    if (taken & (load | (f_came != 2'd2))) f_came <= load ? 2'd1 : f_came + 2'd1;
    else if (load) f_came <= 2'd0;
    if (reset) f_came <= 2'd0;
end
always @* begin
    moves_on: assert (blocked | !blocked_now | (f_came != 2'd2) | load);
    moves_on_counts: assert ((f_came != 2'd3) & (overdue == (f_came == 2'd2)) & (one_gone == (f_came != 2'd0)));
end
reg f_reading; initial f_reading = 1'b0;
always @(posedge clock) f_reading <= reading & !reset;
always @* read_is_one_snapshot: assert (!f_reading | (!load & !show));

// snapshot_lasts: Results are held for at least 7 us after each read of them, unless a word is read whose address is not above the last one.
reg [3:0] f_ticks; initial f_ticks = 4'd0;
reg f_new; initial f_new = 1'b0;
reg f_past_valid; initial f_past_valid = 1'b0;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    f_new <= request & is_result;
    if (tick_us & !f_ticks[3]) f_ticks <= f_ticks + 4'd1;
    if ((request & is_result) | reset) f_ticks <= 4'd0;
    if (f_past_valid & !$past(reset) & $past(holding) & !holding) snapshot_lasts: assert (f_ticks[3] | (f_new & !$past(goes_on)));
end
always @* begin
    snapshot_lasts_counts: assert (!holding | (quiet_us == f_ticks));
    snapshot_lasts_begins: assert ((settle == 2'd0) | ((quiet_us == f_ticks) & (f_ticks + {2'd0, settle} <= 4'd3)));
end

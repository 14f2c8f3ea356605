// good_means: A position is good only if the CRC, F1 and F2 are right, its settings were whole, and an answer was accepted.
// one_result_each: An answer gives one result at most, and only a frame that was answered, refused, late or given up gives one.
// lost_is_told: A lost trigger is kept until a result reports it.
reg f_past_valid; initial f_past_valid = 1'b0;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (f_past_valid & !$past(reset) & $past(overrun) & !overrun)
        lost_is_told: assert ((publish | late_fault) & ((flags_told & TRIGGER_OVERRUN) != 20'd0));
end
reg f_reason; initial f_reason = 1'b0;
reg f_checked; initial f_checked = 1'b0;
reg f_open; initial f_open = 1'b0;
reg f_proves; initial f_proves = 1'b0;
// an answer that was proved in the cycle before and is not given up in this one
wire f_proved = f_proves & f_open & !was_given_up;
always @(posedge clock) begin
    f_proves <= !reset & prove & (f_open | was_taken) & !was_given_up;
    f_checked <= !reset & f_proved & crc_ok & stored_ok & !f1 & f2 & !settings_upset;
    f_reason <= !reset & (f_proved | refused | announced | was_given_up);
    if (was_taken) f_open <= 1'b1;
    if (reset | was_given_up | f_proved) f_open <= 1'b0;
end
always @* begin
    good_means: assert (!good | f_checked);
    one_result_each: assert (!publish | f_reason);
    one_result_each_open: assert (f_open == pending);
    one_result_each_proved: assert (f_proves == prove_seen);
end

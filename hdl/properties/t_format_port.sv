// lost_trigger_is_reported: A lost trigger is kept until the result of a trigger reports it.
reg f_past_valid; initial f_past_valid = 1'b0;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (f_past_valid & !$past(reset) & $past(lost) & !lost) lost_trigger_is_reported: assert ($past(over & !is_own));
end
